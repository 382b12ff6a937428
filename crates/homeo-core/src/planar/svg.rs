//! Polygons as shapes of an SVG drawing.

use kurbo::{Affine, BezPath, Ellipse, PathEl, Point, Rect, Shape, flatten};
use roxmltree::{Document, Node};
use svgtypes::{PointsParser, Transform};

use super::{Point2, PolygonFileError};

/// Containers whose shapes are not drawn where they stand.
const NOT_DRAWN: [&str; 6] = ["defs", "clipPath", "mask", "pattern", "symbol", "marker"];

/// The rings of a drawing, in document order: each subpath of a `path` is one, and each `polygon`, `rect`, `circle` and
/// `ellipse`. Open subpaths are closed. Coordinates are those of the drawing, downwards, with all `transform` attributes
/// applied; `viewBox` and units of length are not.
///
/// Corners of straight edges stay as they are, to the last bit where there is no transform. Curves become edges that miss them
/// by no more than `tolerance` times the diagonal of their shape; arcs of paths become cubic curves first, which miss them by
/// up to 3e-4 of their radius.
///
/// # Errors
/// The text is no XML, a shape cannot be read (which one, and why), or there is none.
///
/// ```
/// use homeo_core::planar::read_svg;
/// let drawing = r#"<svg><path d="M0 0h9v9h-9z M3 3v3h3z"/></svg>"#;
/// let rings = read_svg(drawing, 1e-3)?;
/// assert_eq!(rings, [vec![[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]], vec![[3.0, 3.0], [3.0, 6.0], [6.0, 6.0]]]);
/// # Ok::<(), homeo_core::planar::PolygonFileError>(())
/// ```
pub fn read_svg(text: &str, tolerance: f64) -> Result<Vec<Vec<Point2>>, PolygonFileError> {
    let document = Document::parse(text).map_err(|error| PolygonFileError(format!("no SVG: {error}")))?;
    let mut rings = Vec::new();
    for node in document.descendants().filter(|node| node.is_element() && is_drawn(*node)) {
        let wrong = |what: String| {
            let line = document.text_pos_at(node.range().start).row;
            PolygonFileError(format!("the {} in line {line}: {what}", node.tag_name().name()))
        };
        if let Some(shape) = shape(node, tolerance).map_err(wrong)? {
            let placed = place(node, shape).map_err(wrong)?;
            if !placed.is_finite() {
                return Err(wrong("a coordinate is not finite".to_owned()));
            }
            rings.extend(subpaths(&placed, tolerance));
        }
    }
    if rings.is_empty() {
        return Err(PolygonFileError("the drawing has no path, polygon, rect, circle or ellipse".to_owned()));
    }
    Ok(rings)
}

fn is_drawn(node: Node) -> bool {
    !node.ancestors().any(|above| NOT_DRAWN.contains(&above.tag_name().name()))
}

/// The outline of an element, if it is a closed shape.
fn shape(node: Node, tolerance: f64) -> Result<Option<BezPath>, String> {
    let number = |name: &str| -> Result<f64, String> {
        let text = node.attribute(name).unwrap_or("0").trim().trim_end_matches("px");
        text.parse().map_err(|_| format!("{name}=\"{text}\" is no number without a unit"))
    };
    let radii = |x: &str, y: &str| -> Result<Ellipse, String> {
        Ok(Ellipse::new(Point::new(number("cx")?, number("cy")?), (number(x)?, number(y)?), 0.0))
    };
    // They become cubic curves first, a tenth as far from them as their edges may be.
    let round = |ellipse: Ellipse| ellipse.to_path(0.1 * tolerance * ellipse.radii().x.max(ellipse.radii().y));
    Ok(Some(match node.tag_name().name() {
        "path" => BezPath::from_svg(node.attribute("d").unwrap_or_default()).map_err(|error| error.to_string())?,
        "polygon" => {
            let text = node.attribute("points").unwrap_or_default();
            let points = PointsParser::from(text).map(|(x, y)| Point::new(x, y));
            let mut path = BezPath::new();
            points.enumerate().for_each(|(k, p)| if k == 0 { path.move_to(p) } else { path.line_to(p) });
            path
        }
        "rect" => {
            if ["rx", "ry"].iter().any(|name| node.has_attribute(*name)) {
                return Err("corners are rounded: make it a path".to_owned());
            }
            let [x, y] = [number("x")?, number("y")?];
            Rect::new(x, y, x + number("width")?, y + number("height")?).to_path(tolerance)
        }
        "circle" => round(radii("r", "r")?),
        "ellipse" => round(radii("rx", "ry")?),
        _ => return Ok(None),
    }))
}

/// Where a shape lies in the drawing.
fn place(node: Node, shape: BezPath) -> Result<BezPath, String> {
    let mut placed = shape;
    // The innermost transform comes first.
    for text in node.ancestors().filter_map(|above| above.attribute("transform")) {
        let Transform { a, b, c, d, e, f } = text.parse().map_err(|error| format!("transform=\"{text}\": {error}"))?;
        placed.apply_affine(Affine::new([a, b, c, d, e, f]));
    }
    Ok(placed)
}

/// The rings of a path, curves cut into edges.
fn subpaths(path: &BezPath, tolerance: f64) -> Vec<Vec<Point2>> {
    let bounds = path.bounding_box();
    let allowed = (tolerance * bounds.width().hypot(bounds.height())).max(f64::MIN_POSITIVE);
    let mut rings: Vec<Vec<Point2>> = Vec::new();
    flatten(path, allowed, |element| match element {
        PathEl::MoveTo(p) => rings.push(vec![[p.x, p.y]]),
        PathEl::LineTo(p) => {
            if let Some(ring) = rings.last_mut() {
                ring.push([p.x, p.y]);
            }
        }
        _ => {}
    });
    for ring in &mut rings {
        // Drawings often return to the beginning before they close.
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
    }
    rings.retain(|ring| ring.len() > 1);
    rings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rings(body: &str) -> Vec<Vec<Point2>> {
        read_svg(&format!("<svg xmlns=\"http://www.w3.org/2000/svg\">{body}</svg>"), 1e-3).unwrap()
    }

    #[test]
    fn corners_stay_to_the_last_bit() {
        let found = rings("<path d=\"M0.1,0.2 L3,.7 1e-3,5.000000000000001 L0.1,0.2 Z\"/>");
        assert_eq!(found, [[[0.1, 0.2], [3.0, 0.7], [1e-3, 5.000_000_000_000_001]]]);
        assert_eq!(rings("<polygon points=\"0,0 4,0 4,3\"/>"), [[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]]]);
        assert_eq!(rings("<rect x=\"1\" width=\"2\" height=\"3px\"/>")[0].len(), 4);
    }

    #[test]
    fn transforms_are_applied_from_the_inside_out() {
        let found = rings("<g transform=\"translate(10 0)\"><path transform=\"scale(2)\" d=\"M0 0h1v1z\"/></g>");
        assert_eq!(found, [[[10.0, 0.0], [12.0, 0.0], [12.0, 2.0]]]);
    }

    #[test]
    fn curves_are_as_near_as_asked() {
        for (tolerance, most) in [(1e-2, 20), (1e-4, 200)] {
            let text = "<svg><circle cx=\"5\" cy=\"5\" r=\"2\"/></svg>";
            let ring = &read_svg(text, tolerance).unwrap()[0];
            assert!((6..most).contains(&ring.len()), "{} corners", ring.len());
            let middle = |k: usize| -> f64 {
                let (p, q) = (ring[k], ring[(k + 1) % ring.len()]);
                (0.5 * (p[0] + q[0]) - 5.0).hypot(0.5 * (p[1] + q[1]) - 5.0)
            };
            let miss = (0..ring.len()).map(|k| (middle(k) - 2.0).abs()).fold(0.0, f64::max);
            assert!(miss <= 1.1 * tolerance * 4.0 * 2f64.sqrt(), "{miss}");
            assert!(miss > 1e-3 * tolerance, "far too fine: {miss}");
        }
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        let message = |text: &str| read_svg(text, 1e-3).unwrap_err().to_string();
        assert!(message("<svg><path").starts_with("no SVG"));
        assert!(message("<svg>\n<path d=\"M0 0 Q1\"/></svg>").contains("the path in line 2"));
        assert!(message("<svg><text>M0 0</text></svg>").contains("no path"));
        assert!(message("<svg><rect rx=\"1\" width=\"4\" height=\"4\"/></svg>").contains("rounded"));
        assert!(message("<svg><circle r=\"1em\"/></svg>").contains("no number"));
        assert!(message("<svg><defs><path d=\"M0 0h1v1z\"/></defs></svg>").contains("no path"));
        assert!(message("<svg><path transform=\"turn(4)\" d=\"M0 0h1v1z\"/></svg>").contains("transform"));
        assert!(message("<svg><path d=\"M0 0h1e400v1z\"/></svg>").contains("the path"));
    }
}
