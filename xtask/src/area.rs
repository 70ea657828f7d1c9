//! What the FPGA's design takes of the device, as Yosys maps it: measured, written into
//! `rtl/README.md`, read from there.

mod sources;
mod table;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, ensure};
use serde::Deserialize;

use crate::measure::Measurement;
use crate::yosys::run_yosys;

pub use table::{committed, ensure_fresh, write};

/// What a 5CSEMA5 has: adaptive logic modules, flip-flops (four a module), memory blocks, multiplier blocks.
const LIMITS: [u32; 4] = [32_070, 4 * 32_070, 397, 87];
/// Memory blocks that the project allows a number of pixel units.
const M10K_MAX: [(u32, u32); 2] = [(8, 320), (4, 310)];
/// Look-up tables and adder bits that the project allows: 60 % of the modules, even if each held but one.
const ALUTS_MAX: u32 = LIMITS[0] / 10 * 6;
/// Multiplier blocks that the project allows.
const DSP_MAX: u32 = 60;

/// The design's area with one number of pixel units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Area {
    /// Pixel units.
    pub units: u32,
    /// Look-up tables and adder bits.
    pub aluts: u32,
    /// Flip-flops.
    pub flip_flops: u32,
    /// Memory blocks.
    pub m10k: u32,
    /// Multiplier blocks.
    pub dsp: u32,
    /// Cells on the longest path between flip-flops or memories.
    pub longest_path: u32,
}

#[derive(Deserialize)]
struct Statistics {
    design: Design,
}

#[derive(Deserialize)]
struct Design {
    num_cells_by_type: BTreeMap<String, u32>,
}

/// Synthesizes the design in a [folder](crate::yosys::folder_with_design) for the Cyclone V.
///
/// # Errors
/// When Yosys fails (its log is named), or when memories became flip-flops or too many blocks.
pub fn synthesize(yosys: &Path, folder: &Path, units: u32) -> anyhow::Result<Area> {
    let file = |kind: &str| folder.join(format!("n{units}.{kind}"));
    let (statistics, path) = (file("json"), file("path"));
    run_yosys(yosys, folder, &format!("n{units}"), &script(units))?;
    let text = fs::read_to_string(&statistics).with_context(|| format!("cannot read {}", statistics.display()))?;
    let Statistics { design } = serde_json::from_str(&text).context("Yosys' statistics are not as expected")?;
    let path = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let area = Area::new(units, &design.num_cells_by_type, &path)?;
    area.check()?;
    Ok(area)
}

/// Yosys' memory block has one clock, so VGA's is taken for the bus's: that changes no count.
fn script(units: u32) -> String {
    let synthesize = "synth_intel_alm -family cyclonev -top halfspace -noiopad -noclkbuf";
    format!(
        "read_slang -j 1 -D SYNTHESIS -F rtl/files.f --top halfspace -G PixelUnits={units}; \
         delete -port halfspace/vga_clk_i; connect -set vga_clk_i clk_i; \
         {synthesize} -run begin:map_bram; memory_bram -rules rtl/area/m10k.txt; \
         techmap -map +/intel_alm/common/bram_m10k_map.v; {synthesize} -run map_lutram:check; \
         tee -q -o n{units}.json stat -json; delete t:MISTRAL_FF t:MISTRAL_M10K; tee -q -o n{units}.path ltp"
    )
}

impl Area {
    fn new(units: u32, cells: &BTreeMap<String, u32>, path: &str) -> anyhow::Result<Self> {
        let sum = |begin: &str| cells.iter().filter(|(name, _)| name.starts_with(begin)).map(|(_, count)| count).sum();
        let length = path.split("(length=").nth(1).and_then(|rest| rest.split(')').next());
        let longest_path = length.and_then(|text| text.parse().ok()).context("Yosys named no longest path")?;
        Ok(Self {
            units,
            aluts: sum("MISTRAL_ALUT"),
            flip_flops: sum("MISTRAL_FF"),
            m10k: sum("MISTRAL_M10K"),
            dsp: sum("MISTRAL_MUL"),
            longest_path,
        })
    }

    /// Two look-up tables or adder bits fit in an adaptive logic module; not all pairs do.
    fn alms_at_least(&self) -> u32 {
        self.aluts.div_ceil(2)
    }

    /// Both buffers and depth are 2.4 million bits: flip-flops could not hold a part of them unseen.
    fn check(&self) -> anyhow::Result<()> {
        let Self { units, m10k, flip_flops, .. } = *self;
        ensure!(m10k >= 300 && flip_flops < 20_000, "{units} pixel units: memories became flip-flops ({flip_flops})");
        for (what, value, most) in self.barred() {
            if let Some(most) = most {
                ensure!(
                    value <= most,
                    "{units} pixel units take {value} {what}, more than the {most} that the project allows"
                );
            }
        }
        Ok(())
    }

    /// What the project has bars for: name, value, largest allowed value.
    fn barred(&self) -> [(&'static str, u32, Option<u32>); 3] {
        let m10k_max = M10K_MAX.iter().find(|(units, _)| *units == self.units).map(|(_, most)| *most);
        [("M10K", self.m10k, m10k_max), ("ALUTs", self.aluts, Some(ALUTS_MAX)), ("DSP blocks", self.dsp, Some(DSP_MAX))]
    }
}

/// Returns the committed areas by the names of `cargo xtask bench`.
///
/// # Errors
/// As [`committed`].
pub fn measurements() -> anyhow::Result<Vec<Measurement>> {
    let figures = |area: &Area| {
        let units = area.units;
        let [m10k, aluts, dsp] = area.barred();
        [("m10k", m10k, "blocks"), ("aluts", aluts, "ALUTs"), ("dsp", dsp, "blocks")].map(
            |(name, (_, value, most), unit)| Measurement {
                bar: most.map(f64::from),
                ..Measurement::new(&format!("rtl.n{units}.{name}"), f64::from(value), unit)
            },
        )
    };
    Ok(committed()?.iter().flat_map(figures).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verilated::UNITS;

    fn area() -> Area {
        Area { units: 8, aluts: 8067, flip_flops: 4291, m10k: 316, dsp: 0, longest_path: 71 }
    }

    #[test]
    fn cells_are_counted_by_kind() {
        let cells = [
            ("MISTRAL_ALUT2", 7),
            ("MISTRAL_ALUT_ARITH", 5),
            ("MISTRAL_FF", 3),
            ("MISTRAL_M10K", 2),
            ("MISTRAL_MUL18X18", 1),
        ];
        let cells = cells.into_iter().map(|(name, count)| (name.to_string(), count)).collect();
        let area =
            Area::new(4, &cells, "\nLongest topological path in halfspace (length=71):\n 0: x").expect("it is whole");
        assert_eq!(area, Area { units: 4, aluts: 12, flip_flops: 3, m10k: 2, dsp: 1, longest_path: 71 });
        assert_eq!(area.alms_at_least(), 6);
        assert!(Area::new(4, &cells, "no path").is_err());
    }

    #[test]
    fn memories_that_became_flip_flops_are_noticed() {
        assert!(area().check().is_ok());
        let error = Area { m10k: 20, flip_flops: 2_400_000, ..area() }.check().expect_err("not memories").to_string();
        assert!(error.contains("became flip-flops"), "{error}");
        let error = Area { m10k: 321, ..area() }.check().expect_err("too many").to_string();
        assert!(error.contains("321 M10K, more than the 320"), "{error}");
        let error = Area { aluts: 19_243, ..area() }.check().expect_err("too many").to_string();
        assert!(error.contains("19243 ALUTs, more than the 19242"), "{error}");
        let error = Area { dsp: 61, ..area() }.check().expect_err("too many").to_string();
        assert!(error.contains("61 DSP blocks, more than the 60"), "{error}");
    }

    #[test]
    fn the_committed_table_is_whole_and_within_the_bars() {
        let areas = committed().expect("a table");
        assert_eq!(areas.len(), UNITS.len());
        areas.iter().for_each(|area| area.check().expect("within the bars"));
    }

    #[test]
    fn measurements_come_with_the_bars() {
        let measurements = measurements().expect("a table");
        let bar = |name: &str| measurements.iter().find(|it| it.name == name).expect("measured").bar;
        assert_eq!(bar("rtl.n8.m10k"), Some(320.0));
        assert_eq!(bar("rtl.n4.m10k"), Some(310.0));
        assert_eq!(bar("rtl.n2.m10k"), None);
        assert_eq!(bar("rtl.n1.aluts"), Some(19_242.0));
        assert_eq!(bar("rtl.n8.dsp"), Some(60.0));
    }
}
