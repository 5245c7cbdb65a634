//! Arbitrary bytes through the readers of pictures and colours, and onto a floor.

use super::colour::Tint;
use super::outline::Affine;
use super::picture::Picture;
use super::{Floor, Window};
use crate::geometry::point;

/// A picture as a project keeps it, which is then looked at. Nothing may panic.
pub fn picture(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    // A whole word is a colour now and then.
    let _ = Tint::named(text.get(..9).unwrap_or(&text));
    let (path, text) = match text.strip_prefix('P') {
        Some(rest) => ("a.png", rest),
        None => ("a.svg", text.as_ref()),
    };
    let Ok(picture) = Picture::read(path, text) else {
        return;
    };
    let mut floor = Floor::default();
    floor.add_picture(&picture, &Affine([300.0, 0.0, 0.0, 200.0, -150.0, -100.0]));
    let mut window = Window::default();
    for degrees in [0.0, 33.3, 180.0] {
        floor.view(point(0.0, 0.0), degrees, 18, 2.0, &mut window);
        assert_eq!(window.pixels.len(), 35 * 35);
    }
}

#[cfg(test)]
mod tests {
    use super::picture;
    use crate::random::Random;

    #[test]
    fn damaged_pictures_do_no_harm() {
        let seeds: [&[u8]; 2] = [
            include_bytes!("../../../../fuzz/seeds/picture/line.svg"),
            include_bytes!("../../../../fuzz/seeds/picture/pixel.txt"),
        ];
        let mut random = Random::new(5);
        for seed in seeds {
            picture(seed);
            for _ in 0..500 {
                let mut bytes = seed.to_vec();
                for _ in 0..=random.bits() % 4 {
                    let at = (random.unit() * bytes.len() as f64) as usize;
                    let other = (random.unit() * bytes.len() as f64) as usize;
                    bytes[at] = bytes[other];
                }
                picture(&bytes);
            }
        }
    }
}
