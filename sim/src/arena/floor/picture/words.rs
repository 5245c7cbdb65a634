//! Why a picture is not shown on a floor, in Russian.
//!
//! Owns the texts. The English ones stand with the errors.

use super::Refusal;
use crate::limits;

/// The sentence.
pub(super) fn russian(why: &Refusal) -> String {
    match why {
        Refusal::Fault(why) => why.russian(),
        Refusal::NotBase64(at) => format!("байт {at} картинки - не Base64"),
        Refusal::TooLong => format!("в картинке больше {} байт", limits::PICTURE_BYTES),
        Refusal::Empty => "картинка пуста".to_owned(),
        Refusal::LongSvg(bytes) => format!(
            "в SVG байт {bytes}, больше {}: сделайте из него PNG",
            limits::SVG_BYTES
        ),
        Refusal::StrangeSvg => "SVG не читается: в нём слишком странный размер".to_owned(),
        Refusal::Svg(why) => format!("SVG не читается: {why}"),
        Refusal::ManyLayers(count) => format!(
            "в SVG линий и областей {count}, больше {}: сделайте из него PNG",
            limits::PICTURE_LAYERS
        ),
    }
}
