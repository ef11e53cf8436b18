//! A panel of a chart: axes with lines and bands.

/// One set of axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// title
    pub title: String,
    /// with its unit
    pub x_label: String,
    /// with its unit
    pub y_label: String,
    /// drawn in order
    pub lines: Vec<Line>,
    /// drawn below the lines
    pub bands: Vec<Band>,
    /// shaded intervals of the abscissa
    pub spans: Vec<[f64; 2]>,
    /// words for the shading, for the legend
    pub spans_label: String,
    /// panels with the same number have the same time as their abscissa: they share a cursor
    pub cursor: Option<usize>,
    /// logarithmic abscissa, ordinate
    pub log: (bool, bool),
}

/// One line of a chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Line {
    /// text of the legend; none if it is empty
    pub label: String,
    /// abscissa
    pub x: Vec<f64>,
    /// ordinate; values that are not finite are left out
    pub y: Vec<f64>,
    /// style
    pub stroke: Stroke,
    /// index of the colour; `None`: the index of the line
    pub colour: Option<usize>,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stroke {
    /// through all points
    #[default]
    Solid,
    /// through all points, dashed
    Dashed,
    /// from the axis up to each point
    Stems,
    /// the points alone
    Dots,
}

/// An interval at each abscissa.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Band {
    /// abscissa
    pub x: Vec<f64>,
    /// lower end
    pub low: Vec<f64>,
    /// upper end
    pub high: Vec<f64>,
    /// index of the colour
    pub colour: usize,
}
