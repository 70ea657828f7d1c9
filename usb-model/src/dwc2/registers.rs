//! Offsets and bits, as in Linux's `drivers/usb/dwc2/hw.h`.

#![allow(missing_docs, reason = "names of the databook, which the table in `hw.h` explains")]

pub const GOTGCTL: u32 = 0x000;
pub const GAHBCFG: u32 = 0x008;
pub const GUSBCFG: u32 = 0x00c;
pub const GRSTCTL: u32 = 0x010;
pub const GINTSTS: u32 = 0x014;
pub const GINTMSK: u32 = 0x018;
pub const GRXFSIZ: u32 = 0x024;
pub const GNPTXFSIZ: u32 = 0x028;
pub const GSNPSID: u32 = 0x040;
pub const GHWCFG1: u32 = 0x044;
pub const GHWCFG4: u32 = 0x050;
pub const HPTXFSIZ: u32 = 0x100;
pub const HCFG: u32 = 0x400;
pub const HFIR: u32 = 0x404;
pub const HFNUM: u32 = 0x408;
pub const HAINT: u32 = 0x414;
pub const HAINTMSK: u32 = 0x418;
pub const HPRT: u32 = 0x440;
pub const CHANNEL_0: u32 = 0x500;
pub const CHANNEL_END: u32 = 0x700;
pub const CHANNEL_STRIDE: u32 = 0x20;
pub const HCCHAR: u32 = 0x00;
pub const HCSPLT: u32 = 0x04;
pub const HCINT: u32 = 0x08;
pub const HCINTMSK: u32 = 0x0c;
pub const HCTSIZ: u32 = 0x10;
pub const HCDMA: u32 = 0x14;
pub const PCGCTL: u32 = 0xe00;

pub const GAHBCFG_GLOBAL: u32 = 1;
pub const GAHBCFG_DMA: u32 = 1 << 5;
pub const GUSBCFG_PHY_16: u32 = 1 << 3;
/// PHYIF16, ULPI, FSINTF, PHYSEL, DDRSEL: the choice of the PHY, which survives a soft reset.
pub const GUSBCFG_PHY: u32 = 0xf8;
pub const GUSBCFG_FORCE_HOST: u32 = 1 << 29;
pub const GUSBCFG_FORCE_DEVICE: u32 = 1 << 30;
pub const GRSTCTL_CORE: u32 = 1;
pub const GRSTCTL_RX_FLUSH: u32 = 1 << 4;
pub const GRSTCTL_TX_FLUSH: u32 = 1 << 5;
pub const GRSTCTL_IDLE: u32 = 1 << 31;
pub const GINT_HOST: u32 = 1;
pub const GINT_SOF: u32 = 1 << 3;
pub const GINT_PORT: u32 = 1 << 24;
pub const GINT_CHANNEL: u32 = 1 << 25;
pub const GINT_DISCONNECT: u32 = 1 << 29;
pub const HCFG_CLOCK: u32 = 3;
pub const HCFG_FULL_SPEED: u32 = 1 << 2;
pub const HCFG_DESCRIPTOR_DMA: u32 = 1 << 23;
pub const HPRT_CONNECTED: u32 = 1;
pub const HPRT_CONNECT_DETECTED: u32 = 1 << 1;
pub const HPRT_ENABLED: u32 = 1 << 2;
pub const HPRT_ENABLE_CHANGED: u32 = 1 << 3;
pub const HPRT_OVERCURRENT: u32 = 1 << 4;
pub const HPRT_OVERCURRENT_CHANGED: u32 = 1 << 5;
pub const HPRT_RESET: u32 = 1 << 8;
pub const HPRT_POWER: u32 = 1 << 12;
pub const HPRT_CHANGES: u32 = HPRT_CONNECT_DETECTED | HPRT_ENABLE_CHANGED | HPRT_OVERCURRENT_CHANGED;
pub const HCCHAR_INPUT: u32 = 1 << 15;
pub const HCCHAR_LOW_SPEED: u32 = 1 << 17;
pub const HCCHAR_ODD_FRAME: u32 = 1 << 29;
pub const HCCHAR_DISABLE: u32 = 1 << 30;
pub const HCCHAR_ENABLE: u32 = 1 << 31;
pub const HCSPLT_COMPLETE: u32 = 1 << 16;
pub const HCSPLT_ENABLE: u32 = 1 << 31;
pub const HCINT_COMPLETE: u32 = 1;
pub const HCINT_HALTED: u32 = 1 << 1;
pub const HCINT_BUS_ERROR: u32 = 1 << 2;
pub const HCINT_STALL: u32 = 1 << 3;
pub const HCINT_NAK: u32 = 1 << 4;
pub const HCINT_ACK: u32 = 1 << 5;
pub const HCINT_NYET: u32 = 1 << 6;
pub const HCINT_NO_ANSWER: u32 = 1 << 7;
pub const HCINT_BABBLE: u32 = 1 << 8;
pub const HCINT_FRAME_OVERRUN: u32 = 1 << 9;
pub const HCINT_TOGGLE: u32 = 1 << 10;
pub const HCTSIZ_PING: u32 = 1 << 31;

/// HCTSIZ's packet identifiers.
pub const DATA0: u32 = 0;
pub const DATA1: u32 = 2;
pub const SETUP: u32 = 3;
/// The same bits, read back after an IN: MDATA.
pub const MDATA: u32 = 3;
