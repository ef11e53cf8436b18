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
