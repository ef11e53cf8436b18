//! The equation of an effect: what the documentation of its type says, for programs as well as for readers of the source.

/// Defines the type of an effect with its documentation, and that documentation as the constant `EQUATION`, in Markdown.
macro_rules! documented {
    ($(#[doc = $line:literal])+ #[derive($($derived:ident),+)] pub struct $name:ident;) => {
        $(#[doc = $line])+
        #[derive($($derived),+)]
        pub struct $name;

        impl $name {
            /// The documentation of the type.
            const EQUATION: &'static str = concat!($($line, "\n"),+);
        }
    };
}

pub(super) use documented;
