//! The rules that the model watches, and the record of those that were broken.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

macro_rules! rules {
    ($($name:ident: $text:literal, $source:literal;)*) => {
        /// A rule of the core's, the bus's or the memory's that software has to keep.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Rule {
            $(#[doc = $text] #[doc = ""] #[doc = concat!("Source: ", $source)] $name,)*
        }

        impl Rule {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// What it asks for.
            pub fn text(self) -> &'static str {
                match self {
                    $(Self::$name => $text,)*
                }
            }

            /// Where it is written.
            pub fn source(self) -> &'static str {
                match self {
                    $(Self::$name => $source,)*
                }
            }
        }
    };
}

rules! {
    ResetWhileBusy: "A soft reset waits until the bus master is idle.", "Linux `dwc2/core.c` dwc2_core_reset; U-Boot `dwc2.c`";
    AccessInReset: "While the soft reset runs, and until the bus master is idle again, only GRSTCTL is touched; the identity may be read.", "Linux `dwc2/core.c` dwc2_core_reset";
    DeviceMode: "Host registers are written in host mode only: 25 ms after it was forced.", "Linux `dwc2/core.c` dwc2_force_mode";
    PhyWithoutReset: "A change of the PHY's choice is followed by a soft reset.", "Linux `dwc2/core.c` dwc2_hs_phy_init; U-Boot `dwc2.c`";
    BothRoles: "The core is forced to be a host or a device, not both.", "Linux `dwc2/hw.h`, GUSBCFG bits 29 and 30";
    FifoOverlap: "The three FIFOs do not overlap.", "Linux `dwc2/hcd.c` dwc2_config_fifos";
    FifoTooDeep: "The FIFOs and one word a channel fit into the FIFO memory.", "Linux `dwc2/hcd.c` dwc2_config_fifos; GHWCFG3";
    FifoTooSmall: "A FIFO holds the largest packet that goes through it.", "Linux `dwc2/hcd.c` dwc2_calculate_dynamic_fifo";
    FifoNotFlushed: "FIFOs that changed size are flushed before they are used.", "U-Boot `dwc2.c`; Linux `dwc2/hcd.c` dwc2_core_host_init";
    DmaOff: "A channel is given a DMA address only while GAHBCFG.DMA_EN is set.", "Linux `dwc2/hw.h`; QEMU does not care";
    DmaUnaligned: "A DMA address is a multiple of four.", "Linux `dwc2/hcd.c` (it copies what is not)";
    DmaOutside: "A DMA address lies in memory.", "Linux `dwc2/hcd_intr.c` dwc2_hc_ahberr_intr";
    DescriptorDma: "Descriptor DMA is off where the driver gives buffers.", "Linux `dwc2/hw.h`, HCFG bit 23";
    BufferShared: "Two running channels do not share a buffer that one of them writes.", "plain DMA";
    BufferTouched: "The processor leaves a buffer alone while the core owns it.", "plain DMA";
    NotCleaned: "What the core reads was cleaned from the caches.", "ARM ARM, non-coherent DMA";
    DirtyUnderWrite: "No dirty cache line covers what the core writes: it would be written back over it.", "ARM ARM, non-coherent DMA";
    NotInvalidated: "What the core wrote is invalidated before the processor reads it.", "ARM ARM, non-coherent DMA";
    ClockSelect: "HCFG.FSLSPCLKSEL is 0 with a high-speed PHY.", "Linux `dwc2/hcd.c` dwc2_init_fs_ls_pclk_sel";
    FrameInterval: "HFIR fits the PHY's clock and the port's speed.", "Linux `dwc2/hcd.c` dwc2_calc_frame_interval";
    PortEnableWritten: "HPRT's enable bit is written as 0: a 1 disables the port.", "Linux `dwc2/hcd.c` dwc2_read_hprt0";
    PortEventLost: "HPRT's write-one-to-clear bits are cleared only after they were read.", "Linux `dwc2/hcd_intr.c` dwc2_port_intr";
    PortUnpowered: "The bus is reset with power on and a device there.", "USB 2.0 §7.1.7.3";
    Debounce: "A connection is stable for 100 ms before the reset.", "USB 2.0 §7.1.7.3, TATTDB";
    ResetTooShort: "A root port signals reset for 50 ms.", "USB 2.0 §7.1.7.5, TDRSTR";
    ResetRecovery: "A device has 10 ms after a reset before it is talked to.", "USB 2.0 §7.1.7.5, TRSTRCY";
    ResetUnderTraffic: "The bus is reset while no channel runs.", "Linux `dwc2/hcd.c` dwc2_hcd_reset_func";
    AddressShared: "No two devices answer one token: only one at a time is at address 0.", "USB 2.0 §9.1.1.3 and §9.1.1.4";
    PortNotEnabled: "A channel is started only while the port is enabled, as far as software can know.", "Linux `dwc2/hcd.c` dwc2_hcd_urb_enqueue";
    NotUnmasked: "A channel is started with its end unmasked: HCINTMSK, HAINTMSK, GINTMSK, GAHBCFG.", "Linux `dwc2/hcd.c` dwc2_hc_enable_dma_ints";
    NotAcknowledged: "A channel is started with its HCINT clear.", "Linux `dwc2/hcd.c` dwc2_hc_init";
    InterruptIgnored: "An interrupt is answered within 10 ms.", "this project";
    ChannelBusy: "A running channel's registers are left alone, but for telling it to halt.", "Linux `dwc2/hcd.c` dwc2_hc_halt";
    HaltIncomplete: "A channel is told to halt by CHENA and CHDIS together.", "Linux `dwc2/hcd.c` dwc2_hc_halt; U-Boot `dwc2.c`";
    PeriodicHalted: "A periodic channel is left to halt by itself.", "`espressif/esp-usb` PR 577, after the databook";
    NoSuchChannel: "Only channels that the core has are used.", "GHWCFG2";
    PacketCount: "HCTSIZ's packets are the bytes divided by the packet size, rounded up, at least one.", "Linux `dwc2/hcd.c` dwc2_hc_start_transfer";
    InputMultiple: "HCTSIZ's bytes from a device are a multiple of the packet size.", "Linux `dwc2/hcd.c` dwc2_hc_start_transfer";
    PacketSize: "HCCHAR's packet size exists for the endpoint's kind and speed.", "USB 2.0 §5.5.3, §5.7.3, §5.8.3";
    SetupShape: "A SETUP is eight bytes in one packet to a control endpoint.", "USB 2.0 §8.5.3";
    ControlStage: "A control transfer has SETUP, data in its direction and length, and a status the other way.", "USB 2.0 §8.5.3";
    Toggle: "Data goes out, and is expected, with the toggle that the endpoint has reached.", "USB 2.0 §8.6; HCTSIZ.PID";
    LowSpeedBit: "HCCHAR.LSPDDEV tells whether the device is a low-speed one.", "Linux `dwc2/hcd.c` dwc2_hc_init";
    PeriodicCount: "HCCHAR's count is at least one, and an interrupt endpoint gets one packet a frame.", "Linux `dwc2/hcd.c`; USB 2.0 §5.7.3";
    OddFrame: "HCCHAR.ODDFRM names the (micro)frame after the one that HFNUM showed, and HFNUM was read in this one or the one before.", "Linux `dwc2/hcd.c` dwc2_hc_set_even_odd_frame";
    Ping: "After NYET, high-speed data to a device starts with a PING.", "USB 2.0 §8.5.1; HCTSIZ.DOPNG";
    SplitMissing: "A slower device behind a high-speed hub is reached by split transactions.", "USB 2.0 §11.14";
    SplitOnSlowBus: "Only a high-speed bus has split transactions.", "USB 2.0 §11.14";
    SplitHub: "A split names the hub and the port behind which the device is, and its speed.", "USB 2.0 §8.4.2.2";
    SplitSize: "A split moves one packet, and a complete split none to the device.", "Linux `dwc2/hcd.c` dwc2_hc_start_transfer; U-Boot `dwc2.c`";
    SplitPosition: "HCSPLT.XACTPOS is \"all\" but for large isochronous packets.", "Linux `dwc2/hcd.c`; USB 2.0 §8.4.2.2";
    StartSplitFrame: "No periodic start split goes out in microframe 6.", "USB 2.0 §11.18.4";
    CompleteSplitFrame: "Periodic complete splits go out two to four microframes after the start split.", "USB 2.0 §11.18.4; EHCI 1.0 §4.12.2; U-Boot `dwc2.c`";
    CompleteSplitOrder: "Complete splits of one microframe keep the order of their start splits.", "USB 2.0 §11.18.8, as Linux cites it";
    CompleteWithoutStart: "A complete split follows a start split for the same endpoint.", "USB 2.0 §11.14";
    SplitRestarted: "A start split that was taken is followed by complete splits until they are answered, or fail.", "USB 2.0 §11.17.1";
    TtNotCleared: "After three complete splits in a row that failed, a control or bulk endpoint's buffer is cleared before its next transfer.", "USB 2.0 §11.17.1 and §11.24.2.3; Linux `core/hub.c` usb_hub_clear_tt_buffer";
    SplitAbandoned: "What a translator has for a control or bulk endpoint is fetched, or cleared.", "USB 2.0 §11.17.4 and §11.24.2.3";
}

impl Rule {
    /// The test in `host-tests/tests/usb_driver/rules` that fails when a driver that breaks the rule goes unnoticed.
    pub fn test(self) -> String {
        let mut name = String::new();
        for letter in format!("{self:?}").chars() {
            if letter.is_uppercase() && !name.is_empty() {
                name.push('_');
            }
            name.extend(letter.to_lowercase());
        }
        name
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self:?}")
    }
}

/// A rule that was broken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation {
    /// Microseconds since power-on.
    pub time: u64,
    /// Which rule.
    pub rule: Rule,
    /// By what.
    pub detail: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at {} us: {}: {} ({})", self.time, self.rule, self.rule.text(), self.detail)
    }
}

/// The record of broken rules; its clones are the same record.
///
/// When the last clone goes and violations are left, it panics: a test that does not ask for them fails.
#[derive(Debug, Clone, Default)]
pub struct Log(Arc<Record>);

#[derive(Debug, Default)]
struct Record(Mutex<Vec<Violation>>);

impl Log {
    /// Writes one down.
    pub fn add(&self, time: u64, rule: Rule, detail: impl Into<String>) {
        self.0.entries().push(Violation { time, rule, detail: detail.into() });
    }

    /// Takes all of them out: they are forgiven.
    pub fn take(&self) -> Vec<Violation> {
        std::mem::take(&mut *self.0.entries())
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.entries().len()
    }
}

impl Record {
    fn entries(&self) -> MutexGuard<'_, Vec<Violation>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Record {
    fn drop(&mut self) {
        let entries = self.entries();
        if entries.is_empty() || std::thread::panicking() {
            return;
        }
        let lines: Vec<String> = entries.iter().take(10).map(ToString::to_string).collect();
        let count = entries.len();
        drop(entries);
        panic!("{count} rules broken:\n{}", lines.join("\n"));
    }
}
