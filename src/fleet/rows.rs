//! The tables of a fleet. Rows of one log name it by the SHA-256 of its bytes, so tables from many machines lie beside one another.

use crate::table_rows;

/// Version of the tables: it grows when a column changes its meaning or goes.
pub const SCHEMA: i64 = 1;

table_rows! {
    LogRow, "logs", "one log" {
        log: String, "", "SHA-256 of the log's bytes; of a log that was not read whole, of its address and size";
        uri: String, "", "where it was found";
        bytes: i64, "B", "its size";
        status: String, "", "`flown`: at least one flight is in the tables; `no_flight`: it was read and holds none that can be used; `inspected`: it was not asked for flights; `error`: it could not be read within its bounds";
        error: Option<String>, "", "why it has no flight, or could not be read";
        vehicle: Option<String>, "", "its vehicle";
        vehicle_type: Option<String>, "", "type of that vehicle: vehicles of one type are compared";
        format: Option<String>, "", "format, told by its content";
        autopilot: Option<String>, "", "autopilot that flew";
        firmware: Option<String>, "", "its software in its own words";
        system: Option<i64>, "1", "MAVLink system id";
        start_utc_us: Option<i64>, "us", "beginning, microseconds since 1970 UTC";
        span_s: Option<f64>, "s", "from the first to the last sample";
        airborne_s: Option<f64>, "s", "time in the air";
        flights: i64, "1", "flights in the tables";
        verdict: Option<String>, "", "what it is good for, in a sentence or two";
        losses: i64, "1", "kinds of losses met while reading it; each is a row of `warnings`";
    }
}

table_rows! {
    FlightRow, "flights", "one flight of a log" {
        log: String, "", "SHA-256 of the log's bytes";
        flight: i64, "1", "place in the log, from 0";
        vehicle: String, "", "its vehicle";
        vehicle_type: String, "", "type of that vehicle";
        start_utc_us: Option<i64>, "us", "beginning of the log, microseconds since 1970 UTC";
        from_s: f64, "s", "first time in the air, on the vehicle's clock";
        airborne_s: f64, "s", "time in the air";
        vehicle_is_known: bool, "", "mass and lengths of the vehicle are known; otherwise the balance is in shares and arms";
        balance_error: Option<String>, "", "why it shows no balance";
        motion_error: Option<String>, "", "why its motion was not compared";
        verdict: Option<String>, "", "`nothing_missing`, `explained`, `partly_explained` or `unexplained`";
    }
}

table_rows! {
    ParameterRow, "parameters", "one parameter as one flight shows it" {
        log: String, "", "SHA-256 of the log's bytes";
        flight: i64, "1", "place in the log";
        vehicle: String, "", "its vehicle";
        name: String, "", "`mass`, `ixx`, `latency`, `vibration`, `power`, or `effect.parameter`";
        unit: String, "", "unit of value and error";
        value: f64, "in `unit`", "value";
        std: Option<f64>, "in `unit`", "standard error";
        common_std: f64, "in `unit`", "systematic part of the error: it is the same in every flight of the vehicle";
        owner: String, "", "`vehicle`: the same in every flight; `flight`: of the day (load, battery, air), never a change of the vehicle";
        effect: Option<String>, "", "effect that the parameter belongs to";
    }
}

table_rows! {
    EffectRow, "effects", "one effect that a flight shows and the model lacks" {
        log: String, "", "SHA-256 of the log's bytes";
        flight: i64, "1", "place in the log";
        vehicle: String, "", "its vehicle";
        effect: String, "", "identifier of the effect";
        sentence: String, "", "what it means for this vehicle";
        z: f64, "1", "evidence, as a normal deviate";
        gain: f64, "1", "share of the residual energy that it explains";
        may_be: String, "", "effects that explain the flight as well, by commas";
    }
}

table_rows! {
    ResidualRow, "residuals", "what is left of the equation of one axis of a flight" {
        log: String, "", "SHA-256 of the log's bytes";
        flight: i64, "1", "place in the log";
        vehicle: String, "", "its vehicle";
        axis: String, "", "force or torque along which body axis";
        unit: String, "", "N or N m";
        before: f64, "in `unit`", "root mean square by the rigid body alone";
        after: f64, "in `unit`", "root mean square with the effects";
    }
}

table_rows! {
    LegRow, "legs", "two seconds of a flight: what its balance is found from" {
        log: String, "", "SHA-256 of the log's bytes";
        flight: i64, "1", "place in the log";
        vehicle: String, "", "its vehicle";
        time_s: f64, "s", "middle of the leg on the vehicle's clock";
        lean: Vec<f64>, "1", "where the commanded thrust acts along body x and y over the mean arm, and its torque about z over that of all rotors turning one way";
        felt: Vec<f64>, "1", "what the air pushes along body x and y, over the weight";
        turning: Vec<f64>, "rad/s^2", "angular acceleration about body y, x, z";
        rate: Vec<f64>, "rad/s", "body rate about the same axes";
        shares: Vec<f64>, "1", "share of each rotor in the commanded thrust, in the order of the vehicle's description";
        lift: Option<f64>, "1", "specific thrust over g that full commands would give";
        voltage_v: Option<f64>, "V", "battery voltage";
    }
}

table_rows! {
    WarningRow, "warnings", "what is to be known of a log or a flight" {
        log: String, "", "SHA-256 of the log's bytes";
        flight: Option<i64>, "1", "place in the log; empty: of the whole log";
        vehicle: Option<String>, "", "its vehicle";
        severity: String, "", "`loss`, `warning`, `remark`, or `text` of the vehicle";
        text: String, "", "the sentence";
    }
}

table_rows! {
    ProvenanceRow, "provenance", "how the rows of a log were made" {
        log: String, "", "SHA-256 of the log's bytes";
        schema: i64, "1", "version of these tables";
        program: String, "", "name and version of the program";
        settings: String, "", "SHA-256 of the settings and of the vehicle's description that was given";
        depth: String, "", "`inspect`, `balance` or `explain`";
        vehicle_toml: Option<String>, "", "the vehicle's description as it was used: given, or drafted from the log";
        vehicle_given: bool, "", "mass and lengths in it were given";
    }
}

/// All rows of one log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LogRows {
    /// one
    pub logs: Vec<LogRow>,
    /// its flights
    pub flights: Vec<FlightRow>,
    /// their parameters
    pub parameters: Vec<ParameterRow>,
    /// their effects
    pub effects: Vec<EffectRow>,
    /// their residuals
    pub residuals: Vec<ResidualRow>,
    /// their legs
    pub legs: Vec<LegRow>,
    /// what is to be known
    pub warnings: Vec<WarningRow>,
    /// how they were made
    pub provenance: Vec<ProvenanceRow>,
}

/// Does the same with every table of some rows: `$each!(field, RowType)`.
#[macro_export]
macro_rules! each_table {
    ($each:ident) => {
        $each!(logs, $crate::fleet::LogRow);
        $each!(flights, $crate::fleet::FlightRow);
        $each!(parameters, $crate::fleet::ParameterRow);
        $each!(effects, $crate::fleet::EffectRow);
        $each!(residuals, $crate::fleet::ResidualRow);
        $each!(legs, $crate::fleet::LegRow);
        $each!(warnings, $crate::fleet::WarningRow);
        $each!(provenance, $crate::fleet::ProvenanceRow);
    };
}

impl LogRows {
    /// Adds the rows of another log.
    pub fn extend(&mut self, other: Self) {
        macro_rules! each {
            ($field:ident, $row:ty) => {
                self.$field.extend(other.$field);
            };
        }
        each_table!(each);
    }

    /// Number of rows in all tables.
    #[must_use]
    pub fn count(&self) -> usize {
        let mut count = 0;
        macro_rules! each {
            ($field:ident, $row:ty) => {
                count += self.$field.len();
            };
        }
        each_table!(each);
        count
    }
}
