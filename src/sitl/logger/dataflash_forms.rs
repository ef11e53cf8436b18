//! The messages of ArduPilot's log: their numbers, formats and fields.

/// One message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Form {
    pub(super) number: u8,
    pub(super) name: &'static str,
    /// a letter a field
    pub(super) format: &'static str,
    pub(super) fields: &'static str,
    /// a letter a field, of [`UNITS`]
    pub(super) units: &'static str,
}

const fn form(
    number: u8,
    name: &'static str,
    format: &'static str,
    fields: &'static str,
    units: &'static str,
) -> Form {
    Form { number, name, format, fields, units }
}

pub(super) const FMT: Form = form(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns", "-b---");
pub(super) const UNIT: Form = form(129, "UNIT", "QbZ", "TimeUS,Id,Label", "s--");
pub(super) const MULT: Form = form(130, "MULT", "Qbd", "TimeUS,Id,Mult", "s--");
pub(super) const FMTU: Form = form(131, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds", "s---");
pub(super) const PARM: Form = form(132, "PARM", "QNff", "TimeUS,Name,Value,Default", "s---");
pub(super) const MSG: Form = form(133, "MSG", "QZ", "TimeUS,Message", "s-");
pub(super) const MODE: Form = form(134, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn", "s---");
pub(super) const ARM: Form = form(135, "ARM", "QBIBB", "TimeUS,ArmState,ArmChecks,Forced,Method", "s----");
pub(super) const EV: Form = form(136, "EV", "QB", "TimeUS,Id", "s-");
pub(super) const ATT: Form =
    form(137, "ATT", "QffffffB", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,AEKF", "sdddddd-");
pub(super) const RATE: Form = form(
    138,
    "RATE",
    "Qffffffffffff",
    "TimeUS,RDes,R,ROut,PDes,P,POut,YDes,Y,YOut,ADes,A,AOut",
    "skk-kk-kk-oo-",
);
pub(super) const IMU: Form =
    form(139, "IMU", "QBffffffHH", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,GHz,AHz", "s#EEEooozz");
pub(super) const RCOU: Form = form(
    140,
    "RCOU",
    "QHHHHHHHHHHHHHH",
    "TimeUS,C1,C2,C3,C4,C5,C6,C7,C8,C9,C10,C11,C12,C13,C14",
    "sYYYYYYYYYYYYYY",
);
pub(super) const XKF1: Form =
    form(141, "XKF1", "QBccCfffffff", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD", "s#dddnnnnmmm");
pub(super) const GPS: Form =
    form(142, "GPS", "QBBIHBLLefff", "TimeUS,I,Status,GMS,GWk,NSats,Lat,Lng,Alt,Spd,GCrs,VZ", "s#---SDUmnhn");
pub(super) const BARO: Form = form(143, "BARO", "QBf", "TimeUS,I,Alt", "s#m");
pub(super) const BAT: Form = form(144, "BAT", "QBf", "TimeUS,Inst,Volt", "s#v");
pub(super) const PSCN: Form = form(145, "PSCN", "Qffffff", "TimeUS,DPN,PN,DVN,VN,DAN,AN", "smmnnoo");
pub(super) const PSCE: Form = form(146, "PSCE", "Qffffff", "TimeUS,DPE,PE,DVE,VE,DAE,AE", "smmnnoo");
pub(super) const PSCD: Form = form(147, "PSCD", "Qffffff", "TimeUS,DPD,PD,DVD,VD,DAD,AD", "smmnnoo");
pub(super) const ESC: Form = form(148, "ESC", "QBff", "TimeUS,Instance,RPM,Volt", "s#qv");

/// All of them, FMT first.
pub(super) const FORMS: &[Form] = &[
    FMT, UNIT, MULT, FMTU, PARM, MSG, MODE, ARM, EV, ATT, RATE, IMU, RCOU, XKF1, GPS, BARO, BAT, PSCN, PSCE,
    PSCD, ESC,
];

/// Letters of units and what they mean, as ArduPilot writes them.
pub(super) const UNITS: &[(u8, &str)] = &[
    (b'-', ""),
    (b'?', "UNKNOWN"),
    (b'#', "instance"),
    (b'b', "B"),
    (b'd', "deg"),
    (b'D', "deglatitude"),
    (b'E', "rad/s"),
    (b'h', "degheading"),
    (b'k', "deg/s"),
    (b'm', "m"),
    (b'n', "m/s"),
    (b'o', "m/s/s"),
    (b'q', "rpm"),
    (b's', "s"),
    (b'S', "satellites"),
    (b'U', "deglongitude"),
    (b'v', "V"),
    (b'Y', "us"),
    (b'z', "Hz"),
];

/// Letters of multipliers.
pub(super) const MULTIPLIERS: &[(u8, f64)] =
    &[(b'-', 0.0), (b'?', 1.0), (b'0', 1.0), (b'B', 1e-2), (b'F', 1e-6), (b'G', 1e-7)];

impl Form {
    /// A letter a field, of [`MULTIPLIERS`].
    pub(super) fn multipliers(&self) -> String {
        let letter = |(format, unit): (char, char)| match (format, unit) {
            ('Q', 's') => 'F',
            ('c' | 'C' | 'e' | 'E', _) => 'B',
            ('L', _) => 'G',
            (_, '-' | '#') => '-',
            // microseconds are a unit of their own
            _ => '0',
        };
        self.format.chars().zip(self.units.chars()).map(letter).collect()
    }
}
