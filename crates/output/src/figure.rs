//! A figure with logarithmic axes: named marks, each with a second mark above or below it at
//! the same x, and curves through some of them.
//!
//! It is SVG that follows the reader's preference for light or dark, by itself and within a
//! page: colours are classes, which a plotting library would write as fixed values. A mark's
//! details show when the pointer rests on it.

use std::fmt::Write as _;

use super::axis::{Axis, extent, power_of_ten, steps};
use super::html::escape;
use super::label::{Rectangle, Surroundings, place};

/// A point of a series.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// The name beside the mark.
    pub label: String,
    /// The text that the pointer shows.
    pub details: String,
    /// Positive and finite.
    pub x: f64,
    /// Drawn on the plot's edge if it is zero or not finite.
    pub y: f64,
    /// The second mark, joined to the first by a thin line.
    pub second_y: Option<f64>,
}

/// How a series is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// A disk.
    Circle,
    /// A square.
    Square,
    /// A square on its corner.
    Diamond,
}

/// Marks of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The name in the legend.
    pub name: String,
    /// The form of its marks.
    pub symbol: Symbol,
    /// Whether a line goes from each mark to the next.
    pub is_curve: bool,
    /// The marks.
    pub marks: Vec<Mark>,
}

/// A figure. Series take the colours in order; there are [`Figure::COLOURS`].
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The axis at the bottom.
    pub x_title: String,
    /// The axis at the left.
    pub y_title: String,
    /// The name of the second marks in the legend; empty without second marks.
    pub second_title: String,
    /// The series.
    pub series: Vec<Series>,
}

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 720.0;
const PLOT: Rectangle = Rectangle {
    left: 78.0,
    top: 78.0,
    right: 984.0,
    bottom: 662.0,
};
/// Half the size of a mark and of a second mark.
const MARK: f64 = 5.0;
const SECOND: f64 = 3.5;
/// The mean width of a letter of the labels (12 pixels high), rounded up: fonts differ.
const LETTER: f64 = 6.9;
const LABEL_HEIGHT: f64 = 14.0;
/// A label farther than this from its mark is led to it by a line.
const LED: f64 = 16.0;

/// The colours of series are after Okabe and Ito (2008), which colour-blind
/// readers can distinguish; in the dark they are lighter. They are written out
/// where variables would be shorter, for programs other than browsers know none.
const STYLE: &str = "\
.cyl { font: 12px 'DejaVu Sans', Verdana, sans-serif; }
.cyl .paper, .cyl .second { fill: #ffffff; }
.cyl text { fill: #1c1e21; }
.cyl .middle { text-anchor: middle; }
.cyl .end { text-anchor: end; }
.cyl .rule { stroke: #e3e6ea; stroke-width: 1; }
.cyl .axis { stroke: #1c1e21; stroke-width: 1; fill: none; }
.cyl .lead { stroke: #1c1e21; stroke-width: 0.6; opacity: 0.5; }
.cyl .join { stroke: currentColor; stroke-width: 1; opacity: 0.45; }
.cyl .curve { stroke: currentColor; stroke-width: 1.5; fill: none; }
.cyl .first { fill: currentColor; }
.cyl .second { stroke: currentColor; stroke-width: 1.5; }
.cyl .s0 { color: #c45100; } .cyl .s1 { color: #0067a5; } .cyl .s2 { color: #a8468a; } .cyl .s3 { color: #6b7178; } .cyl .s4 { color: #00805c; }
@media (prefers-color-scheme: dark) {
.cyl .paper, .cyl .second { fill: #16181b; }
.cyl text { fill: #e4e6e9; }
.cyl .rule { stroke: #2e3338; }
.cyl .axis, .cyl .lead { stroke: #e4e6e9; }
.cyl .s0 { color: #f0883e; } .cyl .s1 { color: #58b0ee; } .cyl .s2 { color: #df8fc8; } .cyl .s3 { color: #9aa1a9; } .cyl .s4 { color: #35c794; }
}
";

impl Figure {
    /// Series beyond these would have no colour.
    pub const COLOURS: usize = 5;

    /// The figure as an SVG document, which can also be part of a page.
    ///
    /// # Panics
    /// If there are more series than colours.
    #[must_use]
    pub fn svg(&self) -> String {
        assert!(self.series.len() <= Self::COLOURS, "too many series");
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"cyl\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}: {}\">\n<style>\n{STYLE}</style>\n<rect class=\"paper\" width=\"{WIDTH}\" height=\"{HEIGHT}\"/>\n",
            escape(&self.y_title),
            escape(&self.x_title),
        );
        let (x_axis, y_axis) = self.axes();
        self.legend(&mut svg);
        self.grid(&mut svg, &x_axis, &y_axis);
        let at = |mark: &Mark| (x_axis.pixel(mark.x), y_axis.pixel(mark.y));
        for (number, series) in self.series.iter().enumerate() {
            let _ = writeln!(svg, "<g class=\"s{number}\">");
            if series.is_curve {
                let points = series.marks.iter().map(at);
                let points: Vec<String> = points.map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
                let points = points.join(" ");
                let _ = writeln!(svg, "<polyline class=\"curve\" points=\"{points}\"/>");
            }
            for mark in &series.marks {
                let (x, y) = at(mark);
                let details = escape(&mark.details);
                let _ = writeln!(svg, "<g><title>{details}</title>");
                if let Some(second) = mark.second_y {
                    let second = y_axis.pixel(second);
                    line(&mut svg, "join", (x, y), (x, second));
                    symbol(&mut svg, "second", series.symbol, (x, second), SECOND);
                }
                symbol(&mut svg, "first", series.symbol, (x, y), MARK);
                svg.push_str("</g>\n");
            }
            svg.push_str("</g>\n");
        }
        self.labels(&mut svg, &x_axis, &y_axis);
        svg.push_str("</svg>\n");
        svg
    }

    fn marks(&self) -> impl Iterator<Item = &Mark> {
        self.series.iter().flat_map(|series| &series.marks)
    }

    /// Axes that contain every mark that can be drawn: whole decades in y, steps
    /// of 1, 2 and 5 in x.
    fn axes(&self) -> (Axis, Axis) {
        let xs = extent(self.marks().map(|mark| mark.x));
        let ys = self
            .marks()
            .flat_map(|mark| [Some(mark.y), mark.second_y])
            .flatten();
        let (y_low, y_high) = extent(ys);
        let below = steps(xs.0).take_while(|step| step.logarithm <= xs.0).last();
        let above = steps(xs.1).find(|step| step.logarithm >= xs.1);
        let x_low = below.map_or(xs.0, |step| step.logarithm);
        let x_high = above.map_or(xs.1, |step| step.logarithm).max(x_low + 0.1);
        let (y_low, y_high) = (y_low.floor(), y_high.ceil().max(y_low.floor() + 1.0));
        (
            Axis::new((x_low, x_high), PLOT.left + 16.0, PLOT.right - 60.0),
            Axis::new((y_low, y_high), PLOT.bottom - 10.0, PLOT.top + 10.0),
        )
    }

    fn grid(&self, svg: &mut String, x_axis: &Axis, y_axis: &Axis) {
        // No more labels than fit: every decade, or every second, ...
        let decades = (y_axis.high - y_axis.low) as i32;
        let stride = (decades + 13) / 14;
        let first = y_axis.low as i32;
        for decade in (0..=decades).step_by(stride.max(1) as usize) {
            let exponent = first + decade;
            let y = y_axis.pixel(libm::exp10(f64::from(exponent)));
            line(svg, "rule", (PLOT.left, y), (PLOT.right, y));
            text(
                svg,
                "end",
                (PLOT.left - 6.0, y + 4.0),
                &power_of_ten(exponent),
            );
        }
        for step in steps(x_axis.low).take_while(|step| step.logarithm <= x_axis.high + 1e-9) {
            if step.logarithm < x_axis.low - 1e-9 {
                continue;
            }
            let x = x_axis.pixel(libm::exp10(step.logarithm));
            line(svg, "rule", (x, PLOT.top), (x, PLOT.bottom));
            text(svg, "middle", (x, PLOT.bottom + 18.0), &step.text);
        }
        let _ = writeln!(
            svg,
            "<path class=\"axis\" d=\"M{} {}V{}H{}\"/>",
            PLOT.left, PLOT.top, PLOT.bottom, PLOT.right
        );
        let middle = 0.5 * (PLOT.left + PLOT.right);
        text(svg, "middle", (middle, HEIGHT - 16.0), &self.x_title);
        let middle = 0.5 * (PLOT.top + PLOT.bottom);
        let _ = writeln!(
            svg,
            "<text class=\"middle\" transform=\"translate(18 {middle}) rotate(-90)\">{}</text>",
            escape(&self.y_title)
        );
    }

    /// The names of the series in rows above the plot.
    fn legend(&self, svg: &mut String) {
        let (mut x, mut y) = (PLOT.left, 24.0);
        let series = self.series.iter().enumerate();
        let entries = series
            .map(|(number, series)| ("first", number, series.symbol, series.name.as_str()))
            .chain([("second", 3, Symbol::Circle, self.second_title.as_str())])
            .filter(|(.., name)| !name.is_empty());
        for (class, number, shape, name) in entries {
            let width = 34.0 + LETTER * name.chars().count() as f64;
            if x + width > PLOT.right {
                (x, y) = (PLOT.left, y + 22.0);
            }
            let _ = writeln!(svg, "<g class=\"s{number}\">");
            symbol(svg, class, shape, (x + 6.0, y), MARK);
            svg.push_str("</g>\n");
            text(svg, "start", (x + 17.0, y + 4.0), name);
            x += width;
        }
    }

    fn labels(&self, svg: &mut String, x_axis: &Axis, y_axis: &Axis) {
        let at = |mark: &Mark| (x_axis.pixel(mark.x), y_axis.pixel(mark.y));
        let points: Vec<(f64, f64)> = self.marks().map(at).collect();
        let size = |mark: &Mark| (LETTER * mark.label.chars().count() as f64, LABEL_HEIGHT);
        let sizes: Vec<(f64, f64)> = self.marks().map(size).collect();
        let mut marks: Vec<Rectangle> = points
            .iter()
            .map(|&(x, y)| Rectangle::around(x, y, MARK + 1.0))
            .collect();
        let mut lines = Vec::new();
        for (mark, &(x, y)) in self.marks().zip(&points) {
            if let Some(second) = mark.second_y {
                let second = y_axis.pixel(second);
                marks.push(Rectangle::around(x, second, SECOND + 1.0));
                lines.push(Rectangle {
                    left: x - 1.0,
                    top: y.min(second),
                    right: x + 1.0,
                    bottom: y.max(second),
                });
            }
        }
        for series in self.series.iter().filter(|series| series.is_curve) {
            let corners: Vec<(f64, f64)> = series.marks.iter().map(at).collect();
            for ends in corners.windows(2) {
                lines.extend(along(ends[0], ends[1]));
            }
        }
        let around = Surroundings {
            frame: PLOT,
            marks,
            lines,
        };
        let placed = place(&points, &sizes, &around);
        for ((mark, place), &(x, y)) in self.marks().zip(placed).zip(&points) {
            let end = (
                x.clamp(place.left, place.right),
                y.clamp(place.top, place.bottom),
            );
            let (dx, dy) = (end.0 - x, end.1 - y);
            if dx * dx + dy * dy > LED * LED {
                line(svg, "lead", (x, y), end);
            }
            let center = 0.5 * (place.left + place.right);
            text(svg, "middle", (center, place.bottom - 3.0), &mark.label);
        }
    }
}

/// Small squares that cover a slanted line.
fn along((x1, y1): (f64, f64), (x2, y2): (f64, f64)) -> impl Iterator<Item = Rectangle> {
    const HALF: f64 = 1.5;
    let longer = (x2 - x1).abs().max((y2 - y1).abs());
    let count = (longer / (2.0 * HALF)).ceil().max(1.0);
    (0..=count as u32).map(move |index| {
        let part = f64::from(index) / count;
        Rectangle::around(x1 + part * (x2 - x1), y1 + part * (y2 - y1), HALF)
    })
}

fn line(svg: &mut String, class: &str, (x1, y1): (f64, f64), (x2, y2): (f64, f64)) {
    let _ = writeln!(
        svg,
        "<line class=\"{class}\" x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\"/>"
    );
}

fn text(svg: &mut String, class: &str, (x, y): (f64, f64), text: &str) {
    let text = escape(text);
    let _ = writeln!(
        svg,
        "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\">{text}</text>"
    );
}

fn symbol(svg: &mut String, class: &str, symbol: Symbol, (x, y): (f64, f64), half: f64) {
    let _ = match symbol {
        Symbol::Circle => writeln!(
            svg,
            "<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{half}\"/>"
        ),
        Symbol::Square => writeln!(
            svg,
            "<rect class=\"{class}\" x=\"{:.1}\" y=\"{:.1}\" width=\"{width}\" height=\"{width}\"/>",
            x - half,
            y - half,
            width = 2.0 * half
        ),
        Symbol::Diamond => writeln!(
            svg,
            "<path class=\"{class}\" d=\"M{:.1} {:.1}l{r} {r}l-{r} {r}l-{r} -{r}z\"/>",
            x,
            y - 1.2 * half,
            r = 1.2 * half
        ),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(marks: Vec<Mark>) -> Figure {
        Figure {
            x_title: "ns & more".into(),
            y_title: "error".into(),
            second_title: "worst".into(),
            series: vec![Series {
                name: "all".into(),
                symbol: Symbol::Circle,
                is_curve: true,
                marks,
            }],
        }
    }

    fn mark(x: f64, y: f64, second_y: Option<f64>) -> Mark {
        Mark {
            label: format!("<{x}>"),
            details: String::from("a & b"),
            x,
            y,
            second_y,
        }
    }

    #[test]
    fn axes_hold_all_marks_at_round_numbers() {
        let figure = figure(vec![
            mark(3.0, 1e-5, Some(0.0)),
            mark(48.0, 2.0, Some(700.0)),
        ]);
        let (x, y) = figure.axes();
        assert!((libm::exp10(x.low) - 2.0).abs() < 1e-9);
        assert!((libm::exp10(x.high) - 50.0).abs() < 1e-9);
        assert_eq!((y.low, y.high), (-5.0, 3.0));
    }

    #[test]
    fn svg_has_every_mark_and_escapes_names() {
        let marks = vec![mark(3.0, 1e-5, Some(0.1)), mark(48.0, f64::INFINITY, None)];
        let svg = figure(marks).svg();
        // One more of each in the legend.
        assert_eq!(svg.matches("class=\"first\"").count(), 3, "{svg}");
        assert_eq!(svg.matches("class=\"second\"").count(), 2, "{svg}");
        assert_eq!(svg.matches("class=\"join\"").count(), 1, "{svg}");
        for part in ["&lt;48&gt;", "a &amp; b", "ns &amp; more", "10⁻⁵"] {
            assert!(svg.contains(part), "no {part} in\n{svg}");
        }
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }

    #[test]
    fn svg_of_one_mark_or_none_is_drawn() {
        for marks in [vec![], vec![mark(10.0, 0.0, None)]] {
            let svg = figure(marks).svg();
            assert!(!svg.contains("NaN") && svg.ends_with("</svg>\n"), "{svg}");
        }
    }
}
