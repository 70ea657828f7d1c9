//! `cargo xtask generate`: writes the files that come from one source and are committed.

use crate::cli::GenerateArguments;
use crate::demo::{self, Played};
use crate::found_mesh;
use crate::generated;
use crate::golden::{self, Golden};
use crate::machine::{Machine, with_host, with_host_and_mesh};
use crate::paths::workspace_root;
use crate::picture::write_png;
use crate::progress::Progress;
use crate::recorded_game::{self, Record};
use crate::session::{self, ScenePart};

/// Writes the generated files, or with `--check` only says which are stale.
///
/// # Errors
///
/// When a source cannot be read, a file cannot be written, or with `--check` one is stale.
pub fn run(arguments: &GenerateArguments) -> anyhow::Result<()> {
    let mut stale = Vec::new();
    for file in generated::all()? {
        let fresh = file.is_fresh();
        let state = match (fresh, arguments.check) {
            (true, _) => "fresh  ",
            (false, true) => "stale  ",
            (false, false) => "written",
        };
        println!("{state} {}", file.path);
        match (fresh, arguments.check) {
            (true, _) => {}
            (false, true) => stale.push(file.path),
            (false, false) => file.write()?,
        }
    }
    anyhow::ensure!(stale.is_empty(), "{} stale: run `cargo xtask generate` and commit the result", stale.join(", "));
    if arguments.golden {
        write_golden(golden::DEMO, &session::demo()?, None)?;
        let played = write_golden(golden::SEEDS, &session::seeds()?, None)?;
        for (path, picture) in golden::pictures(&played) {
            write_png(&workspace_root().join(path), picture)?;
        }
        let found = write_golden(golden::FOUND, &found_mesh::parts(), Some(found_mesh::file()?))?;
        if let Some((.., picture)) = found.pictures.last() {
            write_png(&workspace_root().join(found_mesh::PICTURE), picture)?;
        }
        write_png(&workspace_root().join(golden::SHEET), &golden::sheet(&played, &found)?)?;
        let record = Record::of(&session::game()?)?;
        record.write()?;
        println!("written {}: score {}", recorded_game::GOLDEN, record.score());
    }
    Ok(())
}

/// Plays a session and writes the checksums that a session's frames must have from now on.
fn write_golden(path: &str, parts: &[ScenePart], mesh: Option<Vec<u8>>) -> anyhow::Result<Played> {
    let play = |machine: &mut dyn Machine| demo::play(machine, parts, &Progress::new());
    let played = match mesh {
        None => with_host(play)?,
        Some(mesh) => with_host_and_mesh(mesh, play)?,
    };
    let new = Golden::from(&played.report);
    match Golden::read(path) {
        Ok(Some(old)) if old == new => println!("fresh   {path}"),
        old => {
            new.write(path)?;
            println!("written {path}");
            if let Ok(Some(old)) = old
                && let Err(difference) = old.check(&new)
            {
                println!("        first difference: {difference}");
            }
            println!(
                "look at the pictures of `cargo xtask demo` (`--seeds`) before you commit it, and say in the commit why"
            );
        }
    }
    Ok(played)
}
