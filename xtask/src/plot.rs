//! Plots of lines as SVG, both axes in powers of two.

use std::fmt::Write as _;

/// A line of a plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// What it shows.
    pub name: String,
    /// Its points, from left to right; both parts are above 0.
    pub points: Vec<(f64, f64)>,
}

/// A plot: the same ticks on both axes, and the diagonal where y is x.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// What stands above it.
    pub title: String,
    /// What the horizontal axis is.
    pub x: String,
    /// What the vertical axis is.
    pub y: String,
    /// Where the axes have numbers, from low to high, the first and last at the ends.
    pub ticks: Vec<f64>,
    /// The lines.
    pub lines: Vec<Line>,
}

/// The picture's size, and the frame of the axes in it.
const SIZE: [f64; 2] = [760.0, 460.0];
const FRAME: [[f64; 2]; 2] = [[70.0, 50.0], [500.0, 400.0]];
/// Colours that differ in brightness too (Okabe and Ito's), used in turn; the second time round dashed.
const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];

impl Plot {
    /// Returns the plot as the text of an SVG file.
    pub fn svg(&self) -> String {
        let [width, height] = SIZE;
        let [[left, top], [right, bottom]] = FRAME;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
             font-size=\"13\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
        );
        let text = |svg: &mut String, at: [f64; 2], anchor: &str, words: &str| {
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>",
                at[0],
                at[1],
                escaped(words)
            );
        };
        text(&mut svg, [left, 28.0], "start", &self.title);
        text(&mut svg, [(left + right) / 2.0, bottom + 42.0], "middle", &self.x);
        text(&mut svg, [left - 20.0, top - 8.0], "start", &self.y);
        for tick in &self.ticks {
            let [x, y] = self.place((*tick, *tick));
            for [x1, y1, x2, y2] in [[left, y, right, y], [x, top, x, bottom]] {
                let _ = writeln!(svg, "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" stroke=\"#ddd\"/>");
            }
            text(&mut svg, [x, bottom + 20.0], "middle", &tick.to_string());
            text(&mut svg, [left - 10.0, y + 4.0], "end", &tick.to_string());
        }
        let _ = writeln!(svg, "<path d=\"M{left} {bottom}L{right} {top}\" stroke=\"#999\" stroke-dasharray=\"2 4\"/>");
        for (index, line) in self.lines.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let dashes = if index < COLOURS.len() { "" } else { " stroke-dasharray=\"7 4\"" };
            let style = format!("stroke=\"{colour}\" stroke-width=\"2\" fill=\"none\"{dashes}");
            let points: Vec<String> =
                line.points.iter().map(|point| self.place(*point)).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            let _ = writeln!(svg, "<polyline points=\"{}\" {style}/>", points.join(" "));
            let y = top + 10.0 + 24.0 * index as f64;
            let _ = writeln!(svg, "<path d=\"M{:.1} {y:.1}h30\" {style}/>", right + 20.0);
            let last = line.points.last().map_or(0.0, |(_, y)| *y);
            text(&mut svg, [right + 58.0, y + 4.0], "start", &format!("{} ({last:.1})", line.name));
        }
        svg + "</svg>\n"
    }

    /// Where a point stands in the picture.
    fn place(&self, (x, y): (f64, f64)) -> [f64; 2] {
        let (low, high) = (self.ticks.first().copied().unwrap_or(1.0), self.ticks.last().copied().unwrap_or(2.0));
        let part = |value: f64| ((value / low).log2() / (high / low).log2()).clamp(0.0, 1.0);
        let [[left, top], [right, bottom]] = FRAME;
        [left + part(x) * (right - left), bottom - part(y) * (bottom - top)]
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stand_by_their_powers_of_two_and_text_is_escaped() {
        let line = Line { name: "a < b & c".into(), points: vec![(1.0, 1.0), (2.0, 2.0), (8.0, 4.0)] };
        let plot = Plot {
            title: "it".into(),
            x: "x".into(),
            y: "y".into(),
            ticks: vec![1.0, 2.0, 4.0, 8.0],
            lines: vec![line],
        };
        let svg = plot.svg();
        // From (70, 400) to (500, 50): a third of the way, then all of it and two thirds.
        assert!(svg.contains("points=\"70.0,400.0 213.3,283.3 500.0,166.7\""), "{svg}");
        assert!(svg.contains("a &lt; b &amp; c (4.0)"));
        assert_eq!(svg.matches("<svg").count(), svg.matches("</svg>").count());
    }
}
