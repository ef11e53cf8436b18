//! Threads on which setpoints depend come before others, where the system permits it.

/// The least real-time priority: before every ordinary thread, after whatever else is real-time.
#[cfg(target_os = "linux")]
const PRIORITY: i32 = 1;

/// Makes the calling thread a real-time one, which no ordinary thread keeps from its core, as far as the system
/// permits (CAP_SYS_NICE, or RLIMIT_RTPRIO of at least 1); without permission, and on other systems than
/// Linux, it stays as it is. A favourable nice value would not do: a thread that runs keeps its core for
/// milliseconds all the same. Returns whether it is one now.
pub fn raise_priority() -> bool {
    #[cfg(target_os = "linux")]
    {
        use thread_priority::unix::{
            RealtimeThreadSchedulePolicy, ScheduleParams, ThreadSchedulePolicy,
            set_thread_priority_and_policy, thread_native_id,
        };
        let priority =
            thread_priority::ThreadPriority::from_posix(ScheduleParams { sched_priority: PRIORITY });
        let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::RoundRobin);
        set_thread_priority_and_policy(thread_native_id(), priority, policy).is_ok()
    }
    #[cfg(not(target_os = "linux"))]
    false
}

/// Cores on which threads wait for one setpoint: beyond these, one more is hardly ever the first to be free.
const CORES: usize = 4;
/// Threads on each: the system wakes the second where another thread's time slice ends before that of the first.
const THREADS_A_CORE: usize = 2;

/// The cores to bind threads to that wait for the same instant, one entry a thread; empty where threads cannot be bound.
pub(super) fn cores_to_wait_on() -> Vec<usize> {
    #[cfg(target_os = "linux")]
    {
        use rustix::thread::{CpuSet, sched_getaffinity};
        let Ok(permitted) = sched_getaffinity(None) else { return Vec::new() };
        let cores: Vec<usize> = (0..CpuSet::MAX_CPU).filter(|core| permitted.is_set(*core)).collect();
        (0..THREADS_A_CORE).flat_map(|_| cores.iter().copied().take(CORES)).collect()
    }
    #[cfg(not(target_os = "linux"))]
    Vec::new()
}

/// Binds the calling thread to a core; whether it is bound now.
pub(super) fn stay_on(core: usize) -> bool {
    #[cfg(target_os = "linux")]
    {
        use rustix::thread::{CpuSet, sched_setaffinity};
        let mut cores = CpuSet::new();
        cores.set(core);
        sched_setaffinity(None, &cores).is_ok()
    }
    #[cfg(not(target_os = "linux"))]
    {
        let _ = core;
        false
    }
}
