//! Chances and spectra of any series.
//!
//! Nothing here knows of flights, vehicles or recordings, and nothing of the crate is imported.

mod blocks;
mod chance;
mod robust;
mod spectrum;
mod whittle;

pub use blocks::{STRETCHES, chance_by_stretches, percentiles_95, resamples};
pub use chance::{f_tail, joint_chance, normal_deviate};
pub use robust::{median, median_step, normal_sigma, quantile, white_level_of};
pub use spectrum::{
    Coherence, coherence, coherence_of_noise, hann_power, hann_windowed, power_at, transform, without_line,
};
pub use whittle::{Whittle, whittle};
