//! The plots of a sweep: error against what it costs, both axes logarithmic, with the Pareto front and the
//! presets marked; as SVG and as PNG.

use super::OutputError;
use super::png_file::write_rgb_png;
use super::stats_file::write_text;
use super::sweep_table::{DEFAULTS, NamedSettings};
use crate::experiment::{SweepRow, sweep_fronts};
use crate::solve::Technique;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// What the error is plotted against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepCost {
    /// Processor seconds.
    Seconds,
    /// Rays through Embree.
    Rays,
}

/// Width and height in pixels.
const SIZE: (u32, u32) = (1200, 800);
/// The one font: it comes with the program, so that pictures do not depend on the machine's.
pub(super) const FONT: &str = "sans-serif";
/// Room left of the least and right of the greatest value, as a factor.
const ROOM: f64 = 1.4;
/// Least ratio of an axis's ends: a narrower one would have no power of ten to label.
const LEAST_SPAN: f64 = 12.0;

/// A point of a plot.
#[derive(Clone, Debug, PartialEq)]
struct Dot<'a> {
    x: f64,
    /// Relative RMS error in percent.
    y: f64,
    technique: Technique,
    front: bool,
    name: Option<&'a str>,
}

/// Everything that is drawn.
struct Plot<'a> {
    title: String,
    across: &'static str,
    dots: Vec<Dot<'a>>,
    /// Noise of the reference in percent.
    noise: f64,
    ranges: [(f64, f64); 2],
}

/// Writes the plot as `path` with the endings `.svg` and `.png`. Rows without a cost or an error above zero have
/// no place on logarithmic axes and are left out.
///
/// # Errors
/// As [`super::write_atomically`]; [`OutputError::Encoding`] with the plotting library's complaint.
pub fn write_sweep_plot(
    path: &Path,
    scene: &str,
    rows: &[SweepRow],
    names: &NamedSettings,
    cost: SweepCost,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    let plot = Plot::new(scene, rows, names, cost);
    let failed = |reason: String| OutputError::Encoding {
        path: path.to_path_buf(),
        reason,
    };
    register_built_in_font().map_err(failed)?;
    let mut svg = String::new();
    plot.draw(&SVGBackend::with_string(&mut svg, SIZE).into_drawing_area())
        .map_err(|e| failed(e.to_string()))?;
    // Viewers have fonts of their own: first those that are no wider than the one that the drawing was measured with.
    let svg = svg.replace(
        "\"sans-serif\"",
        "\"Noto Sans, Arial, Helvetica, sans-serif\"",
    );
    write_text(&path.with_extension("svg"), &svg, interrupted)?;
    let (width, height) = SIZE;
    let mut pixels = vec![0; 3 * width as usize * height as usize];
    plot.draw(&BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area())
        .map_err(|e| failed(e.to_string()))?;
    write_rgb_png(
        &path.with_extension("png"),
        [width, height],
        &pixels,
        interrupted,
    )
}

/// Makes [`FONT`] known to the drawing library.
pub(super) fn register_built_in_font() -> Result<(), String> {
    register_font(FONT, FontStyle::Normal, notosans::REGULAR_TTF)
        .map_err(|_| "the built-in font cannot be read".to_owned())
}

/// Ends of a logarithmic axis that holds these positive values.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    if low > high {
        return (0.1, 10.0);
    }
    let (low, high) = (low / ROOM, high * ROOM);
    let stretch = (LEAST_SPAN * low / high).max(1.0).sqrt();
    (low / stretch, high * stretch)
}

fn colour(technique: Technique) -> RGBColor {
    // Told apart by people who do not see red and green alike (Okabe and Ito, 2008).
    match technique {
        Technique::Normal => RGBColor(230, 159, 0),
        Technique::Visibility => RGBColor(86, 180, 233),
        Technique::Occlusion => RGBColor(0, 158, 115),
        Technique::Blockers => RGBColor(204, 121, 167),
        Technique::Unoccluded => RGBColor(150, 150, 150),
    }
}

const TECHNIQUES: [Technique; 5] = [
    Technique::Normal,
    Technique::Visibility,
    Technique::Occlusion,
    Technique::Blockers,
    Technique::Unoccluded,
];

/// A number as an axis shows it: no exponent where few digits do.
fn label(x: f64) -> String {
    match x {
        x if (0.001..10_000.0).contains(&x) => format!("{}", (x * 1.0e6).round() / 1.0e6),
        x => format!("{x:e}"),
    }
}

impl<'a> Plot<'a> {
    fn new(scene: &str, rows: &[SweepRow], names: &'a NamedSettings, cost: SweepCost) -> Self {
        let mut noise = 0.0;
        let mut dots: Vec<Dot> = Vec::new();
        for (row, [seconds_front, rays_front]) in rows.iter().zip(sweep_fronts(rows)) {
            let (Some(outcome), Some(times)) = (row.outcome, row.processor_seconds()) else {
                continue;
            };
            noise = 100.0 * outcome.reference_noise;
            let (x, front) = match cost {
                SweepCost::Seconds => (times.median, seconds_front),
                SweepCost::Rays => (outcome.rays as f64, rays_front),
            };
            let named = names.iter().find(|(_, settings)| *settings == row.settings);
            let y = 100.0 * outcome.relative_rms;
            if x > 0.0 && y > 0.0 {
                dots.push(Dot {
                    x,
                    y,
                    technique: row.settings.technique,
                    front,
                    name: named.map(|(name, _)| *name),
                });
            }
        }
        let heights = dots
            .iter()
            .map(|d| d.y)
            .chain((noise > 0.0).then_some(noise));
        let ranges = [range(dots.iter().map(|d| d.x)), range(heights)];
        Self {
            title: format!(
                "{scene}: error against {}",
                match cost {
                    SweepCost::Seconds => "processor time",
                    SweepCost::Rays => "rays",
                }
            ),
            across: match cost {
                SweepCost::Seconds => "processor seconds of a solve, all threads together",
                SweepCost::Rays => "rays through Embree",
            },
            dots,
            noise,
            ranges,
        }
    }

    fn draw<DB: DrawingBackend>(
        &self,
        area: &DrawingArea<DB, Shift>,
    ) -> Result<(), DrawingAreaErrorKind<DB::ErrorType>> {
        area.fill(&WHITE)?;
        let [(left, right), (bottom, top)] = self.ranges;
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, (FONT, 26))
            .margin(16)
            .x_label_area_size(56)
            .y_label_area_size(76)
            .build_cartesian_2d((left..right).log_scale(), (bottom..top).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(RGBColor(238, 238, 238))
            .bold_line_style(RGBColor(210, 210, 210))
            .label_style((FONT, 17))
            .axis_desc_style((FONT, 19))
            .x_desc(self.across)
            .y_desc("relative RMS error, %")
            .x_labels(16)
            .y_labels(12)
            .x_label_formatter(&|x| label(*x))
            .y_label_formatter(&|y| label(*y))
            .draw()?;
        if self.noise > 0.0 {
            let level = [(left, self.noise), (right, self.noise)];
            chart
                .draw_series(DashedLineSeries::new(
                    level,
                    6,
                    5,
                    RGBColor(120, 120, 120).into(),
                ))?
                .label("noise of the reference")
                .legend(|(x, y)| PathElement::new([(x, y), (x + 20, y)], RGBColor(120, 120, 120)));
        }
        let mut front: Vec<(f64, f64)> = (self.dots.iter().filter(|d| d.front))
            .map(|d| (d.x, d.y))
            .collect();
        front.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let ring = || BLACK.stroke_width(2);
        chart
            .draw_series(LineSeries::new(front.clone(), BLACK.stroke_width(1)))?
            .label("Pareto front")
            .legend(move |(x, y)| Circle::new((x + 10, y), 7, ring()));
        for technique in TECHNIQUES {
            let mut dots = self
                .dots
                .iter()
                .filter(|d| d.technique == technique)
                .peekable();
            if dots.peek().is_none() {
                continue;
            }
            let style = colour(technique).filled();
            chart
                .draw_series(dots.map(|d| Circle::new((d.x, d.y), 4, style)))?
                .label(technique.name())
                .legend(move |(x, y)| Circle::new((x + 10, y), 5, style));
        }
        chart.draw_series(front.into_iter().map(|at| Circle::new(at, 7, ring())))?;
        let named = |d: &&Dot| d.name.is_some();
        chart.draw_series(self.dots.iter().filter(named).map(|d| {
            let text = match d.name {
                Some(DEFAULTS) => format!("{DEFAULTS} (defaults)"),
                name => name.unwrap_or_default().to_owned(),
            };
            EmptyElement::at((d.x, d.y))
                + TriangleMarker::new((0, 0), 9, RGBColor(213, 94, 0).filled())
                + Text::new(text, (11, -22), (FONT, 19))
        }))?;
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(180, 180, 180))
            .label_font((FONT, 17))
            .draw()?;
        area.present()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_their_values_and_span_a_power_of_ten() {
        for values in [
            vec![3.0],
            vec![0.01, 700.0],
            vec![1.0, 1.0],
            vec![1.0e-300, 1.0e300],
        ] {
            let (low, high) = range(values.iter().copied());
            assert!(
                values.iter().all(|v| (low..=high).contains(v)),
                "{low} {high}"
            );
            assert!(low > 0.0 && high / low >= 10.0);
        }
        let (low, high) = range(std::iter::empty());
        assert!(low > 0.0 && high > low);
    }

    #[test]
    fn labels_are_short() {
        assert_eq!(label(0.1), "0.1");
        assert_eq!(label(20.0), "20");
        assert_eq!(label(1.0e6), "1e6");
    }
}
