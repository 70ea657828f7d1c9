//! PNG files: one picture, or several as an animation (APNG) that browsers and viewers play.

use std::fs::{self, File};
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;
use std::time::Duration;

use anyhow::{Context, bail, ensure};
use png::{BitDepth, ColorType, Compression, Decoder, Encoder, Filter, Limits, Transformations};

use super::Picture;
use super::palette::Palette;

/// Most memory that reading a PNG may take: a wrong file must not take the machine.
const READ_BYTES_MAX: usize = 256 << 20;

/// Writes a picture as a PNG file: of one byte a pixel where 256 colours are enough.
///
/// # Errors
///
/// When the file cannot be written.
pub fn write_png(path: &Path, picture: &Picture) -> anyhow::Result<()> {
    write_file(path, std::slice::from_ref(picture), None)
}

/// Writes pictures of one size as an animated PNG that repeats for ever, each shown for `delay`.
///
/// A viewer that knows no animation shows the first. `delay` is rounded to milliseconds.
///
/// # Errors
///
/// When there is no picture, their sizes differ, the delay is over 65 s or the file cannot be written.
pub fn write_animated_png(path: &Path, frames: &[Picture], delay: Duration) -> anyhow::Result<()> {
    let milliseconds = (delay + Duration::from_micros(500)).as_millis();
    let Ok(milliseconds) = u16::try_from(milliseconds) else {
        bail!("{milliseconds} ms for a frame of {}: at most {} ms", path.display(), u16::MAX);
    };
    write_file(path, frames, Some(milliseconds))
}

fn write_file(path: &Path, frames: &[Picture], milliseconds: Option<u16>) -> anyhow::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    }
    let remedy = || format!("cannot write {}: check the folder and the free space", path.display());
    let mut file = BufWriter::new(File::create(path).with_context(remedy)?);
    encode(&mut file, frames, milliseconds).with_context(remedy)?;
    file.flush().with_context(remedy)
}

/// Writes the frames; `milliseconds` for each makes it an animation.
fn encode(output: impl Write, frames: &[Picture], milliseconds: Option<u16>) -> anyhow::Result<()> {
    let [first, ..] = frames else {
        bail!("there is no frame to write");
    };
    let (width, height) = (first.width(), first.height());
    let mut encoder = Encoder::new(output, width, height);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    let palette = Palette::of(frames);
    match &palette {
        Some(palette) => {
            encoder.set_color(ColorType::Indexed);
            encoder.set_palette(palette.colours());
            encoder.set_filter(Filter::NoFilter);
        }
        None => {
            encoder.set_color(ColorType::Rgb);
            encoder.set_filter(Filter::Adaptive);
        }
    }
    if let Some(milliseconds) = milliseconds {
        encoder.set_animated(u32::try_from(frames.len())?, 0)?;
        encoder.set_frame_delay(milliseconds, 1_000)?;
    }
    let mut writer = encoder.write_header()?;
    for (number, frame) in frames.iter().enumerate() {
        ensure!(
            (frame.width(), frame.height()) == (width, height),
            "frame {number} has {}×{} pixels, the first has {width}×{height}",
            frame.width(),
            frame.height()
        );
        match &palette {
            Some(palette) => writer.write_image_data(&palette.numbers(frame))?,
            None => writer.write_image_data(frame.bytes())?,
        }
    }
    Ok(writer.finish()?)
}

/// Reads a PNG file of any kind as RGB: transparency is dropped, grey becomes RGB, 16 bits become 8;
/// of an animation the first frame.
///
/// # Errors
///
/// When the file cannot be read, is no PNG, or is damaged.
pub fn read_png(path: &Path) -> anyhow::Result<Picture> {
    let file = File::open(path).with_context(|| format!("cannot read {}", path.display()))?;
    let mut decoder = Decoder::new_with_limits(BufReader::new(file), Limits { bytes: READ_BYTES_MAX });
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16);
    decode(decoder).with_context(|| format!("{} is no PNG picture that can be read: write it again", path.display()))
}

fn decode(decoder: Decoder<BufReader<File>>) -> anyhow::Result<Picture> {
    let mut reader = decoder.read_info()?;
    let size = reader.output_buffer_size().context("it is too large")?;
    ensure!(size <= READ_BYTES_MAX, "it takes {size} bytes, more than {READ_BYTES_MAX}");
    let mut bytes = vec![0; size];
    let info = reader.next_frame(&mut bytes)?;
    bytes.truncate(info.buffer_size());
    let pixels = match info.color_type {
        ColorType::Rgb => bytes,
        ColorType::Rgba => {
            bytes.as_chunks::<4>().0.iter().flat_map(|[red, green, blue, _]| [*red, *green, *blue]).collect()
        }
        ColorType::Grayscale => bytes.iter().flat_map(|grey| [*grey; 3]).collect(),
        ColorType::GrayscaleAlpha => bytes.as_chunks::<2>().0.iter().flat_map(|[grey, _]| [*grey; 3]).collect(),
        ColorType::Indexed => bail!("its palette was not expanded"),
    };
    Picture::new(info.width, info.height, pixels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_elf::TestFile;

    /// A picture of `colours` colours (at most width × height) in a fixed pattern.
    fn picture(width: u32, height: u32, colours: u32) -> Picture {
        let pixels = (0..width * height).flat_map(|index| {
            let colour = index % colours;
            [colour as u8, (colour >> 8) as u8, (index % colours / 3) as u8]
        });
        Picture::new(width, height, pixels.collect()).expect("the right size")
    }

    #[test]
    fn a_picture_comes_back_as_it_was() {
        for colours in [1, 2, 255, 256, 257, 5_000] {
            let file = TestFile::new(&format!("{colours}.png"), &[]);
            let picture = picture(100, 70, colours);
            write_png(file.path(), &picture).expect("the temporary folder takes files");
            assert_eq!(read_png(file.path()).expect("just written"), picture, "{colours} colours");
        }
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes() {
        for colours in [200, 3_000] {
            let picture = picture(64, 64, colours);
            let mut files = [Vec::new(), Vec::new()];
            for file in &mut files {
                encode(file, std::slice::from_ref(&picture), None).expect("memory takes bytes");
            }
            assert_eq!(files[0], files[1]);
        }
    }

    #[test]
    fn an_animation_holds_every_frame_with_its_delay() {
        let file = TestFile::new("animated.png", &[]);
        let frames: Vec<Picture> = (1..6).map(|colours| picture(20, 10, colours)).collect();
        write_animated_png(file.path(), &frames, Duration::from_micros(16_667))
            .expect("the temporary folder takes files");
        let mut reader =
            Decoder::new(BufReader::new(File::open(file.path()).expect("just written"))).read_info().expect("a PNG");
        let animation = reader.info().animation_control().expect("an animation");
        assert_eq!((animation.num_frames, animation.num_plays), (5, 0));
        let mut bytes = vec![0; reader.output_buffer_size().expect("small")];
        for _ in &frames {
            reader.next_frame(&mut bytes).expect("a frame");
            let control = reader.info().frame_control().expect("an animation");
            assert_eq!((control.delay_num, control.delay_den), (17, 1_000));
        }
        assert!(reader.next_frame(&mut bytes).is_err());
        assert_eq!(read_png(file.path()).expect("just written"), frames[0]);
    }

    #[test]
    fn wrong_frames_and_files_are_refused() {
        let file = TestFile::new("wrong.png", &[]);
        let path = file.path();
        assert!(write_animated_png(path, &[], Duration::ZERO).is_err());
        let error =
            write_animated_png(path, &[picture(2, 2, 1), picture(3, 2, 1)], Duration::ZERO).expect_err("two sizes");
        assert!(format!("{error:#}").contains("frame 1 has 3×2 pixels, the first has 2×2"), "{error:#}");
        assert!(write_animated_png(path, &[picture(2, 2, 1)], Duration::from_secs(66)).is_err());
        fs::write(path, b"no picture").expect("the temporary folder takes files");
        let error = read_png(path).expect_err("not a PNG");
        assert!(error.to_string().contains("is no PNG picture"), "{error:#}");
        assert!(read_png(Path::new("no.png")).expect_err("missing").to_string().starts_with("cannot read"));
    }
}
