//! The page of `vehicle` for the terminal.

use crate::study::VehicleSummary;
use std::fmt::Write;

/// Names of the mixer's rows.
const WRENCH: [&str; 4] = ["force_z_n", "torque_x_nm", "torque_y_nm", "torque_z_nm"];

/// The page for the terminal.
#[must_use]
pub fn vehicle_text(summary: &VehicleSummary) -> String {
    let [small, middle, large] = summary.principal_moments_kg_m2;
    let hover = summary
        .hover_command
        .map_or("none: full thrust does not lift the weight".to_owned(), |u| format!("{u:.4}"));
    let mut page = format!(
        "{}\n  mass                {} kg, weight {:.3} N at {} m/s^2\n  principal moments   {small:.4e}, {middle:.4e}, {large:.4e} kg m^2\n",
        summary.name, summary.mass_kg, summary.weight_n, summary.gravity_m_s2
    );
    let lines = [
        ("actuator", summary.actuator.clone()),
        ("one rotor's thrust", summary.thrust_law.clone()),
        ("torque per thrust", format!("{:.5} m", summary.torque_per_thrust_m)),
        (
            "full thrust",
            format!("{:.3} N, {:.2} of the weight", summary.thrust_max_n, summary.thrust_to_weight),
        ),
        ("hover command u", hover),
        ("anchor", summary.anchor.clone()),
    ];
    for (name, value) in lines {
        // writing to a String cannot fail
        let _ = writeln!(page, "  {name:<20}{value}");
    }
    let _ = writeln!(page, "  mixer, per newton of each rotor (body FLU, at the centre of mass)");
    let _ = writeln!(
        page,
        "    {:<20}{:>5}{:>12}{:>13}{:>13}{:>13}",
        "rotor", "spin", WRENCH[0], WRENCH[1], WRENCH[2], WRENCH[3]
    );
    for rotor in &summary.rotors {
        let [fz, tx, ty, tz] = rotor.wrench_per_thrust;
        let _ =
            writeln!(page, "    {:<20}{:>5}{fz:>12.4}{tx:>13.5}{ty:>13.5}{tz:>13.5}", rotor.name, rotor.spin);
    }
    if !summary.effect_lines.is_empty() {
        let _ = writeln!(page, "  effects");
    }
    for line in &summary.effect_lines {
        let _ = writeln!(page, "    {line}");
    }
    page.truncate(page.trim_end().len());
    page
}
