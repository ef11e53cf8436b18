//! The frame of a chart in a page: its width, and its title for those who cannot see it.

use crate::text::markup;

/// Dots.
pub(super) const WIDTH: f64 = 640.0;

/// An element for a page with a title for those who cannot see it.
pub(super) fn framed(height: f64, title: &str, draw: &mut dyn FnMut(&mut String)) -> String {
    let mut out = format!(
        r#"<svg viewBox="0 0 {WIDTH} {height:.0}" role="img" fill="currentColor"><title>{}</title>"#,
        markup(title)
    );
    draw(&mut out);
    out.push_str("</svg>\n");
    out
}
