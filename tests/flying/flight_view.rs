//! The terminal view on a made-up screen.

use mavid::fly::finding::Level;
use mavid::fly::preflight::Page;
use mavid::fly::view::{
    Attitude, Battery, LandedView, LinkView, ParameterRow, Phase, PlainLog, StageView, TWIN, Trace,
    ViewModel, render, render_landed,
};
use ratatui::backend::TestBackend;
use ratatui::{Frame, Terminal};

fn drawn(model: &ViewModel, columns: u16, rows: u16) -> String {
    screen(columns, rows, |frame| render(frame, model))
}

fn screen(columns: u16, rows: u16, draw: impl FnOnce(&mut Frame<'_>)) -> String {
    let mut terminal = Terminal::new(TestBackend::new(columns, rows)).unwrap();
    terminal.draw(draw).unwrap();
    let buffer = terminal.backend().buffer().clone();
    let row = |y: u16| (0..columns).map(|x| buffer[(x, y)].symbol()).collect::<String>();
    (0..rows).map(row).collect::<Vec<_>>().join("\n")
}

fn model() -> ViewModel {
    let mut history = Trace::default();
    (0..200).for_each(|step| history.push(2.2 - 0.14 * (1.0 - 0.97_f64.powi(step))));
    let mut model = ViewModel {
        title: "x500, PX4".into(),
        state: "trajectory".into(),
        phase: Phase::Flying,
        mode: "OFFBOARD".into(),
        armed: true,
        elapsed_s: 83.0,
        progress_s: Some((31.0, 50.0)),
        link: LinkView { age_s: Some(0.02), frames_hz: 870.0, bytes_s: 55_400.0, loss: Some(0.013) },
        battery: Battery { percent: Some(76.0), voltage_v: Some(15.42), is_low: false },
        attitude: Some(Attitude { roll_deg: -3.2, position_m: [1.0, -2.0, 3.5], ..Attitude::default() }),
        parameters: vec![
            ParameterRow {
                name: "mass",
                unit: "kg",
                value: Some(2.0614),
                std: Some(0.0123),
                why: None,
                history,
            },
            ParameterRow {
                name: "ixx",
                unit: "kg m^2",
                value: None,
                std: None,
                why: Some("fly more".into()),
                history: Trace::default(),
            },
        ],
        parameters_used_s: 21.0,
        ..ViewModel::default()
    };
    model.tracking.limit_m = Some(1.0);
    (0..50).for_each(|step| model.track(0.01 * f64::from(step)));
    model.event(Level::Ok, "takeoff done");
    model.event(Level::Warning, "setpoints late by 22 ms");
    model
}

#[test]
fn everything_that_matters_is_on_the_screen() {
    let screen = drawn(&model(), 100, 30);
    for wanted in [
        "x500, PX4",
        "trajectory",
        "OFFBOARD",
        "ARMED",
        "31 of 50 s",
        "870/s",
        "55.4 kB/s",
        "1.3 % lost",
        "76 %",
        "15.42 V",
        "0.49 of 1.0 m",
        "roll   -3.2",
        "-2.00",
        "2.061 +- 0.012 kg",
        "not determined yet: fly more",
        "takeoff done",
        "setpoints late",
        "h hold",
        "l land",
        "r return",
    ] {
        assert!(screen.contains(wanted), "no `{wanted}` in\n{screen}");
    }
    let line = screen.lines().find(|line| line.contains("mass")).unwrap();
    assert!(line.contains('█') && line.contains('▁'), "the mass falls to its value: {line}");
}

#[test]
fn the_twin_is_named_wherever_the_word_for_arming_is_asked_for() {
    let page = Page::default().said_of(Some(format!("what flies now is {TWIN}")));
    let mut model = ViewModel { is_twin: true, awaits_word: true, ..model() };
    model.page = Some(page.into());
    let lines = PlainLog::default().lines(&model);
    let named = |begin: &str| lines.iter().any(|line| line.contains(begin) && line.contains(TWIN));
    assert!(
        named("what flies now is") && named("type arm and return") && named("] trajectory"),
        "{lines:#?}"
    );
    let screen = drawn(&model, 80, 24);
    for wanted in [format!("what flies now is {TWIN}"), format!("type arm to fly {TWIN}; Ctrl-C leaves")] {
        assert!(screen.contains(&wanted), "no `{wanted}` in\n{screen}");
    }
    (model.awaits_word, model.is_twin) = (false, true);
    assert!(drawn(&model, 80, 24).contains("Events of the simulated twin"));
    model.is_twin = false;
    assert!(
        !PlainLog::default()
            .lines(&model)
            .iter()
            .any(|line| line.contains("] trajectory, the simulated twin"))
    );
}

#[test]
fn a_tall_screen_has_an_artificial_horizon_the_path_and_the_share_of_the_limit() {
    let mut model = model();
    for step in 0..60 {
        let north_m = 0.1 * f64::from(step);
        let position_m = [north_m, 0.5 * north_m, 1.5];
        // nose up: a positive pitch is nose down
        model.moves(Some(Attitude { roll_deg: 20.0, pitch_deg: -10.0, position_m, ..Attitude::default() }));
    }
    let screen = drawn(&model, 100, 40);
    for wanted in ["Horizon", "▒", "Path, north up", "●", "0.49 of 1.0 m ████░░░░"] {
        assert!(screen.contains(wanted), "no `{wanted}` in\n{screen}");
    }
    // a usual terminal has them beside the parameters of the rigid body, which keep their rows
    let names = ["mass", "ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
    model.parameters = names
        .map(|name| ParameterRow {
            name,
            unit: "kg m^2",
            value: Some(0.0224),
            std: Some(0.0012),
            why: None,
            history: Trace::default(),
        })
        .to_vec();
    let small = drawn(&model, 80, 24);
    let wanted = ["Horizon", "▒", "Path", "●", "takeoff done", "setpoints late by 22 ms", "h hold"];
    for wanted in names.iter().chain(&wanted) {
        assert!(small.contains(wanted), "no `{wanted}` in\n{small}");
    }
    // a narrow one keeps what matters more
    let narrow = drawn(&model, 60, 24);
    assert!(!narrow.contains("Horizon") && narrow.contains("h hold"), "{narrow}");
}

#[test]
fn after_the_landing_the_view_shows_the_analysis_and_then_the_answer() {
    let drawn = |view: &LandedView, columns, rows| screen(columns, rows, |frame| render_landed(frame, view));
    let stage = |name: &str, elapsed_s, steps| StageView {
        name: name.into(),
        elapsed_s,
        steps,
        counted: "flights",
        is_estimate: false,
    };
    let mut view = LandedView {
        title: "mavid-run".into(),
        flown: vec!["landed".into(), "4 periods, 0.016 m rms off the reference".into()],
        stages: vec![
            stage("reading the logs", 0.4, None),
            StageView { is_estimate: true, ..stage("searching for effects", 2.0, Some((2, 7))) },
            stage("designing the next flight", 3.0, Some((3, 12))),
        ],
        notes: vec!["no velocity is recorded".into()],
        ..LandedView::default()
    };
    let working = drawn(&view, 80, 24);
    for wanted in [
        "mavid-run  after the landing",
        "not yet: the flight is analysed",
        "4 periods",
        "reading the logs, 0 s",
        "░ about 5 s left",
        "designing the next flight █████░",
        "3 of 12 flights, 9 s left",
        "no velocity is recorded",
        "Ctrl-C ends the analysis",
    ] {
        assert!(working.contains(wanted), "no `{wanted}` in\n{working}");
    }
    view.answer = Some(
        "Motor 2 (rear left) is weak: its thrust and torque are 10.1 +- 0.2 % less than the others'.".into(),
    );
    view.stays = true;
    let done = drawn(&view, 80, 24);
    for wanted in ["Motor 2 (rear left) is weak", "others'.", "Enter goes on"] {
        assert!(done.contains(wanted), "no `{wanted}` in\n{done}");
    }
    assert!(!done.contains("not yet"), "{done}");
    // the answer is above all else, and is whole on a low terminal too
    assert!(done.find("rear left").unwrap() < done.find("4 periods").unwrap());
    assert!(drawn(&view, 80, 8).contains("others'."));
    for (columns, rows) in [(1, 1), (10, 3), (300, 100)] {
        assert_eq!(drawn(&view, columns, rows).lines().count(), usize::from(rows));
    }
}

#[test]
fn a_computer_that_stalls_is_told_before_all_else() {
    let mut model = model();
    model.stall_s = Some(0.42);
    for columns in [80, 120] {
        let screen = drawn(&model, columns, 24);
        assert!(screen.starts_with("THIS COMPUTER STALLED 0.4 s  x500, PX4"), "{screen}");
    }
    let said = PlainLog::default().lines(&model);
    assert!(said.iter().any(|line| line.contains("this computer stalled 0.4 s")), "{said:?}");
}

#[test]
fn a_word_that_is_being_typed_replaces_the_help() {
    let mut model = model();
    model.typed = Some("ki".into());
    let screen = drawn(&model, 100, 30);
    assert!(screen.contains("ki_") && !screen.contains("h hold"), "{screen}");
}

#[test]
fn an_empty_model_and_a_tiny_screen_are_drawn() {
    let screen = drawn(&ViewModel::default(), 80, 24);
    assert!(screen.contains("nothing heard") && screen.contains("not said"), "{screen}");
    for (columns, rows) in [(1, 1), (10, 3), (20, 8), (300, 100)] {
        assert_eq!(drawn(&model(), columns, rows).lines().count(), usize::from(rows));
    }
}

#[test]
fn memory_is_bounded() {
    let mut model = ViewModel::default();
    for step in 0..100_000_u32 {
        model.event(Level::Ok, "again");
        model.track(f64::from(step));
        let position_m = [f64::from(step), 0.0, 1.0];
        model.moves(Some(Attitude { position_m, ..Attitude::default() }));
    }
    assert!(model.events.len() <= 200);
    assert_eq!(model.event_count, 100_000);
    assert!(model.path_m.len() <= 600);
    assert_eq!(model.tracking.history_m.values().len(), mavid::fly::view::HISTORY);
}
