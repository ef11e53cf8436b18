//! A series as CSV.

use super::series::TimeSeries;

/// A series as CSV, with a head of `time_s` and the names of its values. A value that is missing is an empty cell.
///
/// # Errors
/// Where a row cannot be written.
pub fn to_csv(series: &TimeSeries) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(std::iter::once("time_s").chain(series.columns.iter().map(String::as_str)))?;
    for (index, time_s) in series.time_s.iter().enumerate() {
        let cell = |value: &f64| if value.is_finite() { value.to_string() } else { String::new() };
        writer.write_record(std::iter::once(cell(time_s)).chain(series.sample(index).iter().map(cell)))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_whole_and_missing_values_are_empty() {
        let series = TimeSeries {
            name: "a".to_owned(),
            columns: vec!["x".to_owned(), "y".to_owned()],
            unit: "m",
            time_s: vec![0.1, 0.2],
            values: vec![1.5, f64::NAN, -2.0, 1e-9],
        };
        let text = String::from_utf8(to_csv(&series).unwrap()).unwrap();
        assert_eq!(text, "time_s,x,y\n0.1,1.5,\n0.2,-2,0.000000001\n");
    }
}
