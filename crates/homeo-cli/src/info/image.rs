//! Images, by the headers of PNG and JPEG.

use std::path::Path;

use serde_json::json;

use crate::answer::Answer;
use crate::failure::{Failure, Result};

/// Describes an image.
pub fn describe(bytes: &[u8], path: &Path) -> Result<Answer> {
    let found = if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        png_size(bytes).map(|size| ("png", size))
    } else if bytes.starts_with(b"\xff\xd8") {
        jpeg_size(bytes).map(|size| ("jpeg", size))
    } else {
        return Err(Failure::input(
            "bad-header",
            format!("{}: neither PNG nor JPEG by its first bytes", path.display()),
        ));
    };
    let Some((format, (width, height))) = found.filter(|(_, (w, h))| *w > 0 && *h > 0) else {
        return Err(Failure::input("unexpected-end", format!("{}: the image has no complete header", path.display())));
    };
    let fields = json!({
        "kind": "image", "format": format, "width": width, "height": height, "violations": [],
        "input": {"path": path.display().to_string()},
    });
    Ok(Answer::new(fields, format!("{}: {format} image, {width} by {height} pixels\n", path.display())))
}

fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let header = bytes.get(8..24).filter(|h| &h[4..8] == b"IHDR")?;
    let number = |at: usize| u32::from_be_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
    Some((number(8), number(12)))
}

/// The size stands in the frame header; segments before it are skipped by their lengths.
fn jpeg_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let mut at = 2;
    loop {
        while *bytes.get(at)? == 0xff && *bytes.get(at + 1)? == 0xff {
            at += 1;
        }
        let segment = bytes.get(at..at + 4).filter(|s| s[0] == 0xff)?;
        let (marker, length) = (segment[1], usize::from(u16::from_be_bytes([segment[2], segment[3]])));
        let is_frame = (0xc0..=0xcf).contains(&marker) && ![0xc4, 0xc8, 0xcc].contains(&marker);
        if is_frame {
            let frame = bytes.get(at + 5..at + 9)?;
            let number = |i: usize| u32::from(u16::from_be_bytes([frame[i], frame[i + 1]]));
            return Some((number(2), number(0)));
        }
        if marker == 0xda || length < 2 {
            return None;
        }
        at += 2 + length;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_stand_in_the_headers() {
        let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR".to_vec();
        png.extend([0, 0, 1, 0, 0, 0, 0, 5]);
        assert_eq!(png_size(&png), Some((256, 5)));
        let jpeg = [0xff, 0xd8, 0xff, 0xe0, 0, 3, 9, 0xff, 0xff, 0xc2, 0, 17, 8, 0, 7, 1, 2];
        assert_eq!(jpeg_size(&jpeg), Some((258, 7)));
        assert!((0..jpeg.len()).all(|end| jpeg_size(&jpeg[..end]).is_none()));
    }
}
