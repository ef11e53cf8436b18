//! Tests that wait for the real clock, in one program: they wait side by side, more of them than there are processors.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "../support/flying.rs"]
mod flying;
#[cfg(target_os = "linux")]
#[path = "../support/ground.rs"]
mod ground;
#[cfg(target_os = "linux")]
#[path = "../support/lossy.rs"]
mod lossy;
#[cfg(target_os = "linux")]
#[path = "../support/processes.rs"]
mod processes;
#[cfg(target_os = "linux")]
#[path = "../support/pty.rs"]
mod pty;
#[cfg(target_os = "linux")]
#[path = "../support/python.rs"]
mod python;
#[cfg(target_os = "linux")]
#[path = "../support/stuck.rs"]
mod stuck;
#[cfg(target_os = "linux")]
#[path = "../support/mod.rs"]
mod support;

mod checks;
mod dead_man;
#[cfg(target_os = "linux")]
mod demo;
#[cfg(target_os = "linux")]
mod fetch_interrupted;
#[cfg(target_os = "linux")]
mod log_commands;
#[cfg(target_os = "linux")]
mod loopback;
#[cfg(target_os = "linux")]
mod own_log;
#[cfg(target_os = "linux")]
mod peers;
#[cfg(target_os = "linux")]
mod sitl_peers;
#[cfg(target_os = "linux")]
mod stuck_output;
#[cfg(target_os = "linux")]
mod terminal;

use libtest_mimic::{Arguments, Trial};
use std::future::Future;

/// Tests that run at once, unless `--test-threads` says otherwise: most of them wait for a vehicle most of the time.
const AT_ONCE: usize = 6;

/// Threads of a flight in this process: a part that stands still keeps one.
const WORKERS: usize = 8;

/// The tests of these names.
macro_rules! trials {
    ($($module:ident::$name:ident,)*) => {
        vec![$(Trial::test(concat!(stringify!($module), "::", stringify!($name)), || {
            $module::$name();
            Ok(())
        }),)*]
    };
}

/// The tests of these names, each on a runtime of its own.
macro_rules! flights {
    ($($module:ident::$name:ident,)*) => {
        vec![$(Trial::test(concat!(stringify!($module), "::", stringify!($name)), || {
            on_a_runtime($module::$name());
            Ok(())
        }),)*]
    };
}

fn on_a_runtime(flight: impl Future<Output = ()>) {
    let mut builder = tokio::runtime::Builder::new_multi_thread();
    builder.worker_threads(WORKERS).enable_all().build().unwrap().block_on(flight);
}

fn main() {
    let mut arguments = Arguments::from_args();
    arguments.test_threads.get_or_insert(AT_ONCE);
    let figures = Trial::test("dead_man::twenty_trials_of_each", || {
        on_a_runtime(dead_man::twenty_trials_of_each());
        Ok(())
    });
    let mut tests = vec![figures.with_ignored_flag(true)];
    tests.extend(flights![
        dead_man::a_computer_that_slept_has_stood_still,
        dead_man::whatever_dies_setpoints_end_and_no_mode_is_ordered,
        dead_man::whatever_stands_still_setpoints_end_and_no_mode_is_ordered,
        checks::a_vehicle_that_has_just_booted_is_waited_for,
        checks::a_fence_about_home_lets_a_flight_inside_it_go_on_and_refuses_one_that_leaves_it,
        checks::the_file_of_another_vehicle_is_refused_before_it_is_armed,
        checks::a_vehicle_that_signs_is_flown_with_its_key_alone,
    ]);
    #[cfg(target_os = "linux")]
    tests.splice(0..0, trials![
        // the longest first
        loopback::over_a_bad_network_the_flight_ends_on_the_ground_and_nothing_of_its_log_is_lost,
        loopback::both_autopilots_fly_over_every_link_and_are_identified,
        fetch_interrupted::the_first_interrupt_ends_the_download_and_the_flight_is_analysed,
        demo::the_demo_names_what_it_conceals_with_its_size,
        log_commands::a_flight_sets_the_logging_of_each_autopilot_and_puts_it_back,
        own_log::a_flight_logs_as_it_is_set_and_its_log_is_fetched,
        log_commands::logs_are_listed_fetched_and_prepared_and_what_was_changed_is_put_back,
        demo::what_cannot_be_concealed_is_refused_before_anything_flies,
        log_commands::an_autopilot_is_restarted_where_that_is_said,
        log_commands::a_host_that_refuses_is_not_waited_for,
        log_commands::a_vehicle_hovers_better_with_what_its_model_says,
        log_commands::a_vehicle_without_a_file_is_checked_by_its_own_parameters,
        log_commands::logging_is_not_set_where_the_vehicle_does_not_answer_for_it,
        log_commands::parameters_of_a_file_are_set_read_back_and_undone,
        peers::a_vehicle_played_by_pymavlink_is_flown_to_the_ground_and_its_log_is_read_by_pymavlink_to_the_byte,
        sitl_peers::pymavlink_flies_px4_offboard_in_lockstep_over_udp,
        sitl_peers::pymavlink_flies_ardupilot_guided_fast_over_tcp,
        sitl_peers::mavsdk_finds_px4_healthy_stores_a_fence_and_flies_offboard,
        sitl_peers::pymavlink_fetches_the_log_of_a_flight_of_px4,
        sitl_peers::pymavlink_fetches_the_log_of_a_flight_of_ardupilot,
        sitl_peers::mavsdk_fetches_a_log_by_both_protocols,
        sitl_peers::a_log_that_pymavlink_serves_by_messages_is_fetched_over_a_lossy_link,
        stuck_output::a_recording_ends_on_sigterm_though_nobody_reads_what_it_says,
        stuck_output::a_full_disk_is_told_and_no_frame_is_claimed_that_is_not_there,
        stuck_output::after_a_connection_that_failed_the_same_command_begins_again,
        stuck_output::a_flight_goes_on_though_its_terminal_takes_nothing,
        terminal::a_word_for_arming_that_was_typed_before_the_page_arms_nothing,
        terminal::a_terminal_that_takes_nothing_costs_no_result,
        terminal::a_vehicle_outlives_its_terminal_where_it_was_started_so,
    ]);
    libtest_mimic::run(&arguments, tests).exit();
}
