//! Forms in which ArduPilot's releases since Copter 3.3 define the messages that are read (LogStructure.h), for logs whose
//! definitions are damaged.
//!
//! Without its definition no message of a kind can be read, and a log defines each kind once. Many have one wrong byte in
//! them as soon as one in a hundred bytes of a log is wrong.

use super::definition::{Definition, FMT_BYTES, HEADER_BYTES};
use super::letter::Letter;

/// Where in it the length stands, and behind it name, format and names of fields.
const LENGTH_AT: usize = HEADER_BYTES + 1;
const NAME: (usize, usize) = (5, 4);
const FORMAT: (usize, usize) = (9, 16);
const FIELDS: (usize, usize) = (25, 64);
/// A damaged definition differs from its form in no more bytes of 85. Other forms of the same message differ in
/// fewer, so the nearest one must also be the only one.
const MOST_WRONG: usize = 10;
/// A definition that does not contradict itself differs from its form in no more letters of its fields' names. A
/// release that renames a field changes more.
const MOST_MISSPELT: usize = 2;

/// Name, format, names of fields.
type Form = (&'static str, &'static str, &'static str);

#[rustfmt::skip]
const FORMS: &[Form] = &[
    ("ACC", "QBQfff", "TimeUS,I,SampleUS,AccX,AccY,AccZ"),
    ("ACC1", "QQfff", "TimeUS,SampleUS,AccX,AccY,AccZ"),
    ("ACC2", "QQfff", "TimeUS,SampleUS,AccX,AccY,AccZ"),
    ("ACC3", "QQfff", "TimeUS,SampleUS,AccX,AccY,AccZ"),
    ("AHR2", "QccCfLLffff", "TimeUS,Roll,Pitch,Yaw,Alt,Lat,Lng,Q1,Q2,Q3,Q4"),
    ("ANG", "Qfffffff", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,Dt"),
    ("ARM", "QBH", "TimeUS,ArmState,ArmChecks"),
    ("ARM", "QBIBB", "TimeUS,ArmState,ArmChecks,Forced,Method"),
    ("ATT", "QccccCCCC", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,ErrRP,ErrYaw"),
    ("ATT", "QccccCCCCB", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,ErrRP,ErrYaw,AEKF"),
    ("ATT", "QffffffB", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,AEKF"),
    ("BAR2", "QffcfIff", "TimeUS,Alt,Press,Temp,CRt,SMS,Offset,GndTemp"),
    ("BAR2", "QffcfIffB", "TimeUS,Alt,Press,Temp,CRt,SMS,Offset,GndTemp,Health"),
    ("BAR3", "QffcfIff", "TimeUS,Alt,Press,Temp,CRt,SMS,Offset,GndTemp"),
    ("BAR3", "QffcfIffB", "TimeUS,Alt,Press,Temp,CRt,SMS,Offset,GndTemp,Health"),
    ("BARO", "QBffcfIffB", "TimeUS,I,Alt,Press,Temp,CRt,SMS,Offset,GndTemp,Health"),
    ("BARO", "QBfffcfIffB", "TimeUS,I,Alt,AltAMSL,Press,Temp,CRt,SMS,Offset,GndTemp,Health"),
    ("BARO", "QBfffcfIffBf", "TimeUS,I,Alt,AltAMSL,Press,Temp,CRt,SMS,Offset,GndTemp,H,CPress"),
    ("BARO", "QffcfIff", "TimeUS,Alt,Press,Temp,CRt,SMS,Offset,GndTemp"),
    ("BARO", "QffcfIffB", "TimeUS,Alt,Press,Temp,CRt,SMS,Offset,GndTemp,Health"),
    ("BAT", "QBfffffcfB", "TimeUS,Instance,Volt,VoltR,Curr,CurrTot,EnrgTot,Temp,Res,RemPct"),
    ("BAT", "QBfffffcfBB", "TimeUS,Inst,Volt,VoltR,Curr,CurrTot,EnrgTot,Temp,Res,RemPct,H"),
    ("BAT", "QBfffffcfBBB", "TimeUS,Inst,Volt,VoltR,Curr,CurrTot,EnrgTot,Temp,Res,RemPct,H,SH"),
    ("BAT", "Qffffcf", "TimeUS,Volt,VoltR,Curr,CurrTot,Temp,Res"),
    ("BAT", "Qfffffcf", "TimeUS,Volt,VoltR,Curr,CurrTot,EnrgTot,Temp,Res"),
    ("BAT2", "Qffffcf", "TimeUS,Volt,VoltR,Curr,CurrTot,Temp,Res"),
    ("BAT2", "Qfffffcf", "TimeUS,Volt,VoltR,Curr,CurrTot,EnrgTot,Temp,Res"),
    ("CUR2", "QfffcHHHHHHHHHH", "TimeUS,Volt,Curr,CurrTot,Temp,V1,V2,V3,V4,V5,V6,V7,V8,V9,V10"),
    ("CURR", "QfffcHHHHHHHHHH", "TimeUS,Volt,Curr,CurrTot,Temp,V1,V2,V3,V4,V5,V6,V7,V8,V9,V10"),
    ("DSF", "QIBHIIII", "TimeUS,Dp,IErr,Blk,Bytes,FMn,FMx,FAv"),
    ("DSF", "QIHIIII", "TimeUS,Dp,Blk,Bytes,FMn,FMx,FAv"),
    ("ERR", "QBB", "TimeUS,Subsys,ECode"),
    ("ESC", "QBeeffcfcf", "TimeUS,Instance,RPM,RawRPM,Volt,Curr,Temp,CTot,MotTemp,Err"),
    ("ESC", "QBeffcfcf", "TimeUS,Instance,RPM,Volt,Curr,Temp,CTot,MotTemp,Err"),
    ("ESC", "QBffffcfcf", "TimeUS,Instance,RPM,RawRPM,Volt,Curr,Temp,CTot,MotTemp,Err"),
    ("ESC1", "Qcccc", "TimeUS,RPM,Volt,Curr,Temp"),
    ("ESC1", "QeCCcH", "TimeUS,RPM,Volt,Curr,Temp,CTot"),
    ("ESC2", "Qcccc", "TimeUS,RPM,Volt,Curr,Temp"),
    ("ESC2", "QeCCcH", "TimeUS,RPM,Volt,Curr,Temp,CTot"),
    ("ESC3", "Qcccc", "TimeUS,RPM,Volt,Curr,Temp"),
    ("ESC3", "QeCCcH", "TimeUS,RPM,Volt,Curr,Temp,CTot"),
    ("ESC4", "Qcccc", "TimeUS,RPM,Volt,Curr,Temp"),
    ("ESC4", "QeCCcH", "TimeUS,RPM,Volt,Curr,Temp,CTot"),
    ("ESC5", "Qcccc", "TimeUS,RPM,Volt,Curr,Temp"),
    ("ESC5", "QeCCcH", "TimeUS,RPM,Volt,Curr,Temp,CTot"),
    ("ESC6", "Qcccc", "TimeUS,RPM,Volt,Curr,Temp"),
    ("ESC6", "QeCCcH", "TimeUS,RPM,Volt,Curr,Temp,CTot"),
    ("ESC7", "Qcccc", "TimeUS,RPM,Volt,Curr,Temp"),
    ("ESC7", "QeCCcH", "TimeUS,RPM,Volt,Curr,Temp,CTot"),
    ("ESC8", "Qcccc", "TimeUS,RPM,Volt,Curr,Temp"),
    ("ESC8", "QeCCcH", "TimeUS,RPM,Volt,Curr,Temp,CTot"),
    ("EV", "QB", "TimeUS,Id"),
    ("FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds"),
    ("GPS", "QBBIHBcLLeffffB", "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U"),
    ("GPS", "QBIHBcLLefffB", "TimeUS,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,U"),
    ("GPS", "QBIHBcLLeffffB", "TimeUS,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U"),
    ("GPS2", "QBIHBcLLefffB", "TimeUS,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,U"),
    ("GPS2", "QBIHBcLLeffffB", "TimeUS,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U"),
    ("GUIP", "QBfffbffffff", "TimeUS,Type,pX,pY,pZ,Terrain,vX,vY,vZ,aX,aY,aZ"),
    ("GYR", "QBQfff", "TimeUS,I,SampleUS,GyrX,GyrY,GyrZ"),
    ("GYR1", "QQfff", "TimeUS,SampleUS,GyrX,GyrY,GyrZ"),
    ("GYR2", "QQfff", "TimeUS,SampleUS,GyrX,GyrY,GyrZ"),
    ("GYR3", "QQfff", "TimeUS,SampleUS,GyrX,GyrY,GyrZ"),
    ("IMU", "QBffffffIIfBBHH", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz"),
    ("IMU", "QffffffIIfBBHH", "TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz"),
    ("IMU2", "QffffffIIfBBHH", "TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz"),
    ("IMU3", "QffffffIIfBBHH", "TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz"),
    ("ISBD", "QHHaaa", "TimeUS,N,seqno,x,y,z"),
    ("ISBH", "QHBBHHQf", "TimeUS,N,type,instance,mul,smp_cnt,SampleUS,smp_rate"),
    ("MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn"),
    ("MSG", "QZ", "TimeUS,Message"),
    ("MULT", "Qbd", "TimeUS,Id,Mult"),
    ("NKF1", "QBccCfffffffccce", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH"),
    ("NKF1", "QccCfffffffccc", "TimeUS,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ"),
    ("NKF1", "QccCfffffffccce", "TimeUS,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH"),
    ("NKF4", "QBcccccfffHBIHb", "TimeUS,C,SV,SP,SH,SM,SVT,errRP,OFN,OFE,FS,TS,SS,GPS,PI"),
    ("NKF4", "QcccccfbbHBHHb", "TimeUS,SV,SP,SH,SM,SVT,errRP,OFN,OFE,FS,TS,SS,GPS,PI"),
    ("PARM", "QNf", "TimeUS,Name,Value"),
    ("PARM", "QNff", "TimeUS,Name,Value,Default"),
    ("POS", "QLLfff", "TimeUS,Lat,Lng,Alt,RelHomeAlt,RelOriginAlt"),
    ("PSC", "Qffffffffffff", "TimeUS,TPX,TPY,PX,PY,TVX,TVY,VX,VY,TAX,TAY,AX,AY"),
    ("PSCD", "Qffffffff", "TimeUS,TPD,PD,DVD,TVD,VD,DAD,TAD,AD"),
    ("PSCD", "Qfffffffff", "TimeUS,DPD,TPD,PD,DVD,TVD,VD,DAD,TAD,AD"),
    ("PSCE", "Qffffffff", "TimeUS,TPE,PE,DVE,TVE,VE,DAE,TAE,AE"),
    ("PSCE", "Qfffffffff", "TimeUS,DPE,TPE,PE,DVE,TVE,VE,DAE,TAE,AE"),
    ("PSCN", "Qffffffff", "TimeUS,TPN,PN,DVN,TVN,VN,DAN,TAN,AN"),
    ("PSCN", "Qfffffffff", "TimeUS,DPN,TPN,PN,DVN,TVN,VN,DAN,TAN,AN"),
    ("RATE", "Qffffffffffff", "TimeUS,RDes,R,ROut,PDes,P,POut,YDes,Y,YOut,ADes,A,AOut"),
    ("RATE", "Qfffffffffffff", "TimeUS,RDes,R,ROut,PDes,P,POut,YDes,Y,YOut,ADes,A,AOut,AOutSlew"),
    ("RCO2", "QHHHH", "TimeUS,C15,C16,C17,C18"),
    ("RCO3", "QHHHHHHHHHHHHHH", "TimeUS,C19,C20,C21,C22,C23,C24,C25,C26,C27,C28,C29,C30,C31,C32"),
    ("RCOU", "QHHHHHHHHHHHHHH", "TimeUS,C1,C2,C3,C4,C5,C6,C7,C8,C9,C10,C11,C12,C13,C14"),
    ("RPM", "QBffB", "TimeUS,I,RPM,Qual,H"),
    ("RPM", "Qff", "TimeUS,rpm1,rpm2"),
    ("STAT", "QBfBBBBBB", "TimeUS,isFlying,isFlyProb,Armed,Safety,Crash,Still,Stage,Hit"),
    ("UNIT", "QbZ", "TimeUS,Id,Label"),
    ("XKF1", "QBccCfffffffccce", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH"),
    ("XKF1", "QccCfffffffccc", "TimeUS,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ"),
    ("XKF1", "QccCfffffffccce", "TimeUS,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH"),
    ("XKF4", "QBcccccfffHBIHb", "TimeUS,C,SV,SP,SH,SM,SVT,errRP,OFN,OFE,FS,TS,SS,GPS,PI"),
    ("XKF4", "QcccccfbbHBHHb", "TimeUS,SV,SP,SH,SM,SVT,errRP,OFN,OFE,FS,TS,SS,GPS,PI"),
];

/// What a definition says: as it stands, or as the only form that is near it where it is damaged.
#[must_use]
pub(super) fn defined(message: &[u8]) -> Option<Definition> {
    match Definition::from_message(message) {
        Some(definition) => Some(spelt(message).unwrap_or(definition)),
        None => mended(message),
    }
}

/// The only form that is near a definition, with the definition's number.
#[must_use]
pub(super) fn mended(message: &[u8]) -> Option<Definition> {
    let message: &[u8; FMT_BYTES] = message.first_chunk()?;
    // of the same name: others of the same layout, such as RCIN and RCOU, differ in nothing else
    let is_named = |form: &&Form| name_of(message) == name_of(&image(form));
    let apart = FORMS.iter().filter(is_named).map(|form| (wrong(message, form), *form));
    let mut near: Vec<(usize, Form)> = apart.filter(|(wrong, _)| *wrong <= MOST_WRONG).collect();
    near.sort_by_key(|(wrong, _)| *wrong);
    match near[..] {
        [(_, form)] => of(message, &form),
        [(least, form), (next, _), ..] if least < next => of(message, &form),
        _ => None,
    }
}

/// The form whose names of fields are misspelt in a definition that is the form's otherwise.
fn spelt(message: &[u8]) -> Option<Definition> {
    let message: &[u8; FMT_BYTES] = message.first_chunk()?;
    let is_same = |form: &&Form| {
        let image = image(form);
        image[LENGTH_AT..FIELDS.0] == message[LENGTH_AT..FIELDS.0]
            && (1..=MOST_MISSPELT).contains(&wrong(message, form))
    };
    of(message, FORMS.iter().find(is_same)?)
}

/// Whether a definition is one of ArduPilot's, but for damage.
#[must_use]
pub(super) fn is_known(message: &[u8]) -> bool {
    mended(message).is_some()
}

fn of(message: &[u8; FMT_BYTES], (name, format, fields): &Form) -> Option<Definition> {
    Definition::new(message[HEADER_BYTES], bytes(format), name, format, fields)
}

fn bytes(format: &str) -> usize {
    HEADER_BYTES + format.bytes().filter_map(Letter::of).map(|letter| letter.bytes()).sum::<usize>()
}

/// The definition that says a form, but for header and number.
fn image((name, format, fields): &Form) -> [u8; FMT_BYTES] {
    let mut image = [0; FMT_BYTES];
    image[LENGTH_AT] = u8::try_from(bytes(format)).unwrap_or(u8::MAX);
    for ((from, _), text) in [(NAME, name), (FORMAT, format), (FIELDS, fields)] {
        image[from..from + text.len()].copy_from_slice(text.as_bytes());
    }
    image
}

fn name_of(message: &[u8; FMT_BYTES]) -> &[u8] {
    &message[NAME.0..NAME.0 + NAME.1]
}

/// Bytes in which a definition differs from a form.
fn wrong(message: &[u8; FMT_BYTES], form: &Form) -> usize {
    let pairs = message.iter().zip(image(form)).skip(LENGTH_AT);
    pairs.filter(|(came, form)| **came != *form).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(form: &Form) -> [u8; FMT_BYTES] {
        let mut message = image(form);
        message[..HEADER_BYTES + 1].copy_from_slice(&[0xa3, 0x95, 128, 77]);
        message
    }

    #[test]
    fn each_form_is_a_definition_and_the_only_one_of_its_letters() {
        for form in FORMS {
            let lengths = [(form.0, NAME), (form.1, FORMAT), (form.2, FIELDS)];
            assert!(lengths.iter().all(|(text, (_, most))| text.len() <= *most), "{form:?}");
            let read = Definition::from_message(&message(form)).unwrap();
            assert_eq!((read.number, read.name.as_str()), (77, form.0));
            assert_eq!(defined(&message(form)), Some(read.clone()));
            assert_eq!(mended(&message(form)), Some(read), "{form:?}");
        }
    }

    #[test]
    fn a_damaged_definition_is_known_by_what_is_left_of_it() {
        let form = FORMS.iter().find(|form| form.0 == "RCOU").unwrap();
        let sound = Definition::from_message(&message(form)).unwrap();
        // length, format, names of fields
        for at in [4, 10, 30, 60, 88] {
            let mut damaged = message(form);
            damaged[at] ^= 0x15;
            assert_eq!(defined(&damaged), Some(sound.clone()), "{at}");
        }
        let mut gone = message(form);
        gone[4..40].iter_mut().for_each(|byte| *byte ^= 0x15);
        assert_eq!(defined(&gone), None);
        // another message of the same layout
        let mut damaged = message(form);
        damaged[5..9].copy_from_slice(b"RCIN");
        damaged[30] = 5;
        assert_eq!(defined(&damaged), None);
    }
}
