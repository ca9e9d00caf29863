//! An SVG figure as pixels, for documents that take no SVG. It brings its own font, so that it looks the same on a machine
//! without any.

use std::sync::Arc;

use png::{ColorType, Compression, Encoder, EncodingError};
use resvg::tiny_skia::{Color, Pixmap, PremultipliedColorU8, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};

/// Width of the picture, pixels.
const WIDTH: f32 = 1600.0;

/// The figure on white as the bytes of a PNG file, 1600 pixels wide; or why not.
pub fn png(svg: &str) -> Result<Vec<u8>, String> {
    let mut fonts = Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    let family = fonts
        .faces()
        .find_map(|face| face.families.first().map(|(name, _)| name.clone()));
    fonts.set_sans_serif_family(family.unwrap_or_default());
    let options = Options {
        fontdb: Arc::new(fonts),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    let (size, scale) = (tree.size(), WIDTH / tree.size().width());
    let height = (scale * size.height()).ceil();
    let mut picture = Pixmap::new(WIDTH as u32, height as u32)
        .ok_or_else(|| format!("a picture of {WIDTH} x {height} pixels cannot be made"))?;
    picture.fill(Color::WHITE);
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut picture.as_mut(),
    );
    encode(&picture).map_err(|error| error.to_string())
}

/// Written fast rather than small, and without the opacity of a picture that has none: by the usual way the pictures of
/// a run cost more than its fields.
fn encode(picture: &Pixmap) -> Result<Vec<u8>, EncodingError> {
    let colours = |pixel: &PremultipliedColorU8| [pixel.red(), pixel.green(), pixel.blue()];
    let bytes: Vec<u8> = picture.pixels().iter().flat_map(colours).collect();
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, picture.width(), picture.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_compression(Compression::Fast);
    encoder.write_header()?.write_image_data(&bytes)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_words_leave_ink() {
        let svg = |body: &str| {
            format!("<svg xmlns='http://www.w3.org/2000/svg' width='80' height='40'>{body}</svg>")
        };
        let word =
            "<text x='5' y='30' font-size='20' font-family='Helvetica, sans-serif'>force</text>";
        let ink = |body: &str| {
            let picture = Pixmap::decode_png(&png(&svg(body)).unwrap()).unwrap();
            assert_eq!((picture.width(), picture.height()), (1600, 800));
            picture
                .pixels()
                .iter()
                .filter(|pixel| pixel.red() < 128)
                .count()
        };
        assert_eq!(ink(""), 0);
        assert!(ink(word) > 1000, "no font");
        assert!(ink("<path d='M0 20 H80' stroke='black'/>") > 1000);
        assert!(png("<svg").is_err());
    }
}
