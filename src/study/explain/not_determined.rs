//! Words for what flights do not determine of the inertia.

/// Why moments of inertia are not determined where the excitation is too small.
pub(in crate::study) const BY_CONTROL: &str = "almost all rotation was the controller's answer to the noise of the \
                                               gyroscopes; fly an identification trajectory, which excites the \
                                               rotation";

/// Why an entry of the inertia is not determined that the model has from the vehicle file.
pub(in crate::study) const KEPT: &str =
    "the flight alone tells too little of it, so the model has about what the vehicle file states";
