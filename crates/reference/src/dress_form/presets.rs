//! Named sizes.

use std::sync::OnceLock;

use super::measurements::{Figure, Measurements};

/// A named set of measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// `astm-00`, `astm-0` to `astm-20`, `eu-34` to `eu-52`, `man-44` to `man-58`, `child-80` to `child-164`,
    /// `average-woman`, `average-man`.
    pub name: String,
    /// Where the numbers come from, and which are estimates.
    pub source: &'static str,
    /// What the form is built from.
    pub measurements: Measurements,
}

impl Preset {
    /// The preset called `name`; letter case, spaces and underscores do not matter (`EU 38` is `eu-38`).
    pub fn find(name: &str) -> Option<&'static Preset> {
        let plain = |text: &str| {
            text.chars()
                .filter(|c| c.is_ascii_alphanumeric())
                .map(|c| c.to_ascii_lowercase())
                .collect::<String>()
        };
        let wanted = plain(name);
        presets().iter().find(|preset| plain(&preset.name) == wanted)
    }
}

/// All presets: women's sizes, averages, men's and children's sizes.
pub fn presets() -> &'static [Preset] {
    static PRESETS: OnceLock<Vec<Preset>> = OnceLock::new();
    PRESETS.get_or_init(|| {
        let mut all = astm();
        all.extend(eu());
        all.extend(averages());
        all.extend(men());
        all.extend(children());
        all
    })
}

const INCH: f64 = 2.54;

/// ASTM D5585-11e1, misses sizes, inches: size, bust, under bust, straight waist, neck base, all from the standard's table.
const ASTM: [(&str, [f64; 4]); 12] = [
    ("00", [31.125, 25.75, 25.375, 13.25]),
    ("0", [31.75, 26.5, 26.125, 13.5]),
    ("2", [33.0, 27.25, 26.875, 13.75]),
    ("4", [34.125, 28.0, 27.625, 14.0]),
    ("6", [35.25, 29.0, 28.5, 14.25]),
    ("8", [36.25, 30.0, 29.5, 14.625]),
    ("10", [37.25, 31.0, 30.5, 14.875]),
    ("12", [38.75, 32.5, 32.25, 15.125]),
    ("14", [40.375, 34.0, 34.0, 15.5]),
    ("16", [42.125, 35.75, 36.0, 15.75]),
    ("18", [44.0, 37.625, 38.25, 16.0]),
    ("20", [46.0, 39.625, 40.5, 16.375]),
];

fn astm() -> Vec<Preset> {
    ASTM.iter()
        .map(|&(size, [bust, underbust, waist, neck])| Preset {
            name: format!("astm-{size}"),
            source: "ASTM D5585-11e1, misses, straight figure: bust, under bust, waist and neck base from its table; hip (bust + \
                     2 1/4 in) and height (65 1/2 in) are estimates",
            measurements: Measurements {
                height: Some(65.5 * INCH),
                bust: Some(bust * INCH),
                underbust: Some(underbust * INCH),
                waist: Some(waist * INCH),
                hip: Some((bust + 2.25) * INCH),
                neck: Some(neck * INCH),
                ..Measurements::default()
            },
        })
        .collect()
}

/// European women's sizes: size, bust, waist, hip, cm, at 168 cm.
const EU: [(u32, [f64; 3]); 10] = [
    (34, [80.0, 64.0, 88.0]),
    (36, [84.0, 68.0, 92.0]),
    (38, [88.0, 72.0, 96.0]),
    (40, [92.0, 76.0, 100.0]),
    (42, [96.0, 80.0, 104.0]),
    (44, [100.0, 84.0, 108.0]),
    (46, [104.0, 88.0, 112.0]),
    (48, [110.0, 94.5, 117.0]),
    (50, [116.0, 101.0, 122.0]),
    (52, [122.0, 107.5, 127.0]),
];

fn eu() -> Vec<Preset> {
    EU.iter()
        .map(|&(size, [bust, waist, hip])| Preset {
            name: format!("eu-{size}"),
            source: "European women's sizes (size = bust / 2 - 6 up to 46; from 48 in steps of 6 cm of bust as in EN 13402-3); \
                     eu-38 is 88 / 72 / 96 at 168 cm, the others' waist and hip are graded from it",
            measurements: Measurements {
                height: Some(168.0),
                bust: Some(bust),
                waist: Some(waist),
                hip: Some(hip),
                ..Measurements::default()
            },
        })
        .collect()
}

fn averages() -> Vec<Preset> {
    let source = "average figures: bust, under bust, waist, hip, height";
    [
        ("average-woman", Figure::Woman, [97.4, 80.7, 80.3, 104.1, 166.2]),
        ("average-man", Figure::Man, [102.8, 93.0, 89.0, 102.9, 178.9]),
    ]
    .into_iter()
    .map(|(name, figure, [bust, underbust, waist, hip, height])| Preset {
        name: name.to_owned(),
        source,
        measurements: Measurements {
            figure,
            height: Some(height),
            bust: Some(bust),
            underbust: Some(underbust),
            waist: Some(waist),
            hip: Some(hip),
            ..Measurements::default()
        },
    })
    .collect()
}

/// European men's sizes: size = half the chest; drop 6 (chest - waist = 12 cm) up to 54, then 10 and 8.
const MEN: [(u32, [f64; 4]); 8] = [
    (44, [88.0, 76.0, 92.0, 168.0]),
    (46, [92.0, 80.0, 96.0, 171.0]),
    (48, [96.0, 84.0, 100.0, 174.0]),
    (50, [100.0, 88.0, 104.0, 177.0]),
    (52, [104.0, 92.0, 108.0, 180.0]),
    (54, [108.0, 96.0, 112.0, 182.0]),
    (56, [112.0, 102.0, 116.0, 184.0]),
    (58, [116.0, 108.0, 120.0, 185.0]),
];

fn men() -> Vec<Preset> {
    MEN.iter()
        .map(|&(size, [chest, waist, hip, height])| Preset {
            name: format!("man-{size}"),
            source: "European men's sizes (size = chest / 2, steps of 4 cm as in EN 13402-3); waist, hip and height as usual in the \
                     trade",
            measurements: Measurements {
                figure: Figure::Man,
                height: Some(height),
                bust: Some(chest),
                waist: Some(waist),
                hip: Some(hip),
                ..Measurements::default()
            },
        })
        .collect()
}

/// Children by height, cm: chest, waist, hip.
const CHILDREN: [(u32, [f64; 3]); 12] = [
    (80, [49.0, 48.0, 50.0]),
    (92, [53.0, 51.0, 55.0]),
    (98, [55.0, 52.0, 57.0]),
    (104, [57.0, 53.0, 59.5]),
    (110, [58.5, 54.0, 62.0]),
    (116, [60.0, 55.0, 64.0]),
    (122, [62.0, 56.5, 66.5]),
    (128, [64.0, 58.5, 69.0]),
    (134, [67.0, 60.0, 72.0]),
    (140, [70.0, 62.0, 75.5]),
    (152, [76.0, 65.5, 82.0]),
    (164, [82.0, 69.0, 88.5]),
];

fn children() -> Vec<Preset> {
    CHILDREN
        .iter()
        .map(|&(height, [chest, waist, hip])| Preset {
            name: format!("child-{height}"),
            source: "European children's sizes by height; girths as usual in the trade",
            measurements: Measurements {
                figure: Figure::Child,
                height: Some(f64::from(height)),
                bust: Some(chest),
                waist: Some(waist),
                hip: Some(hip),
                ..Measurements::default()
            },
        })
        .collect()
}
