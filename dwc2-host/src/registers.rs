//! The core's registers, each in one place. Offsets and bits as in Linux's `drivers/usb/dwc2/hw.h`.

use crate::word::register;

register! {
    /// GOTGCTL: OTG control and status.
    Gotgctl @ 0x000 {
        /// The host lets the device ask for the host's role.
        host_negotiation / with_host_negotiation: [10:10] bool,
    }
}

register! {
    /// GAHBCFG: the bus master and the interrupt line.
    Gahbcfg @ 0x008 {
        /// The interrupt line is enabled.
        global_interrupt / with_global_interrupt: [0:0] bool,
        /// AHB burst: 3 is INCR4.
        burst / with_burst: [4:1] u8,
        /// The core moves data by DMA.
        dma / with_dma: [5:5] bool,
    }
}

register! {
    /// GUSBCFG: the PHY and the core's role.
    Gusbcfg @ 0x00c {
        /// Extra PHY clocks that the core waits for an answer.
        timeout_calibration / with_timeout_calibration: [2:0] u8,
        /// The UTMI+ data path is 16 bits wide (and its clock 30 MHz).
        phy_16_bit / with_phy_16_bit: [3:3] bool,
        /// ULPI at double data rate.
        ddr / with_ddr: [7:7] bool,
        /// The session request protocol is used.
        session_request / with_session_request: [8:8] bool,
        /// The host negotiation protocol is used.
        host_negotiation / with_host_negotiation: [9:9] bool,
        /// A ULPI PHY serves full and low speed through its serial interface.
        ulpi_serial / with_ulpi_serial: [17:17] bool,
        /// A ULPI PHY keeps its clock on during suspend.
        ulpi_clock_in_suspend / with_ulpi_clock_in_suspend: [19:19] bool,
        /// A ULPI PHY switches an external supply of VBUS.
        external_vbus / with_external_vbus: [20:20] bool,
        /// Host, whatever the ID pin says.
        force_host / with_force_host: [29:29] bool,
        /// Device, whatever the ID pin says.
        force_device / with_force_device: [30:30] bool,
    }
}

register! {
    /// GRSTCTL: resets and flushes. Its request bits clear themselves.
    Grstctl @ 0x010 {
        /// Resets the core but for its PHY choice.
        core_soft_reset / with_core_soft_reset: [0:0] bool,
        /// Empties the receive FIFO.
        flush_receive / with_flush_receive: [4:4] bool,
        /// Empties transmit FIFOs.
        flush_transmit / with_flush_transmit: [5:5] bool,
        /// Which: 0x10 is all.
        transmit_fifo / with_transmit_fifo: [10:6] u8,
        /// The bus master is idle.
        idle / with_idle: [31:31] bool,
    }
}

register! {
    /// GINTSTS and GINTMSK: interrupts of the whole core.
    Gintsts @ 0x014 {
        /// The core is a host.
        host_mode / with_host_mode: [0:0] bool,
        /// A (micro)frame began; write one to clear.
        start_of_frame / with_start_of_frame: [3:3] bool,
        /// HPRT says more; clears there.
        port / with_port: [24:24] bool,
        /// HAINT says more; clears there.
        channel / with_channel: [25:25] bool,
        /// The device went; write one to clear.
        disconnect / with_disconnect: [29:29] bool,
    }
}

register! {
    /// GINTMSK: which bits of GINTSTS interrupt.
    Gintmsk @ 0x018 {
        /// See GINTSTS.
        start_of_frame / with_start_of_frame: [3:3] bool,
        /// See GINTSTS.
        port / with_port: [24:24] bool,
        /// See GINTSTS.
        channel / with_channel: [25:25] bool,
        /// See GINTSTS.
        disconnect / with_disconnect: [29:29] bool,
    }
}

register! {
    /// GRXFSIZ: the receive FIFO.
    Grxfsiz @ 0x024 {
        /// Words.
        depth / with_depth: [15:0] u16,
    }
}

register! {
    /// GNPTXFSIZ: the FIFO of control and bulk packets to send.
    Gnptxfsiz @ 0x028 {
        /// First word.
        start / with_start: [15:0] u16,
        /// Words.
        depth / with_depth: [31:16] u16,
    }
}

register! {
    /// GSNPSID: "OT" and the release.
    Gsnpsid @ 0x040 {
        /// 0x4f54, "OT".
        product / with_product: [31:16] u16,
    }
}

register! {
    /// GHWCFG2: how the core was built.
    Ghwcfg2 @ 0x048 {
        /// 2: it has an internal DMA.
        architecture / with_architecture: [4:3] u8,
        /// Channels, less one.
        channels / with_channels: [17:14] u8,
    }
}

register! {
    /// GHWCFG3: how the core was built.
    Ghwcfg3 @ 0x04c {
        /// Words of FIFO memory.
        fifo_depth / with_fifo_depth: [31:16] u16,
    }
}

register! {
    /// HPTXFSIZ: the FIFO of interrupt packets to send.
    Hptxfsiz @ 0x100 {
        /// First word.
        start / with_start: [15:0] u16,
        /// Words.
        depth / with_depth: [31:16] u16,
    }
}

register! {
    /// HCFG: the host.
    Hcfg @ 0x400 {
        /// 0: the PHY's clock is 30 or 60 MHz at every speed.
        clock_select / with_clock_select: [1:0] u8,
        /// Never high speed.
        full_speed_only / with_full_speed_only: [2:2] bool,
        /// Descriptor DMA instead of buffer DMA.
        descriptor_dma / with_descriptor_dma: [23:23] bool,
    }
}

register! {
    /// HFIR: PHY clocks in a (micro)frame, less one.
    Hfir @ 0x404 {
        /// The interval.
        interval / with_interval: [15:0] u16,
    }
}

register! {
    /// HFNUM: the (micro)frame.
    Hfnum @ 0x408 {
        /// Number of the frame, at high speed of the microframe, modulo 0x4000.
        number / with_number: [15:0] u16,
    }
}

register! {
    /// HAINT: a bit for every channel whose HCINT holds something that its HCINTMSK lets through.
    Haint @ 0x414 {
        /// The bits.
        channels / with_channels: [15:0] u16,
    }
}

register! {
    /// HAINTMSK: channels that interrupt.
    Haintmsk @ 0x418 {
        /// The bits.
        channels / with_channels: [15:0] u16,
    }
}

register! {
    /// HPRT: the root port. Writing one to `connect_detected`, `enable_changed` or `overcurrent_changed` clears it,
    /// and to `enabled` disables the port: [`kept`](Hprt::kept) is what a write starts from.
    Hprt @ 0x440 {
        /// A device is there.
        connected / with_connected: [0:0] bool,
        /// A device came; write one to clear.
        connect_detected / with_connect_detected: [1:1] bool,
        /// The port is enabled; write one to disable it.
        enabled / with_enabled: [2:2] bool,
        /// `enabled` changed; write one to clear.
        enable_changed / with_enable_changed: [3:3] bool,
        /// Over-current.
        overcurrent / with_overcurrent: [4:4] bool,
        /// `overcurrent` changed; write one to clear.
        overcurrent_changed / with_overcurrent_changed: [5:5] bool,
        /// The port signals reset.
        reset / with_reset: [8:8] bool,
        /// The port has power.
        power / with_power: [12:12] bool,
        /// 0 high, 1 full, 2 low.
        speed / with_speed: [18:17] u8,
    }
}

impl Hprt {
    /// What was read, less the bits that a written one would clear.
    pub(crate) fn kept(self) -> Self {
        self.with_connect_detected(false).with_enabled(false).with_enable_changed(false).with_overcurrent_changed(false)
    }
}

register! {
    /// HCCHAR: what a channel talks to.
    Hcchar @ 0x500 {
        /// Bytes in the largest packet.
        packet_bytes / with_packet_bytes: [10:0] u16,
        /// Endpoint number.
        endpoint / with_endpoint: [14:11] u8,
        /// From the device.
        input / with_input: [15:15] bool,
        /// A low-speed device.
        low_speed / with_low_speed: [17:17] bool,
        /// 0 control, 2 bulk, 3 interrupt.
        kind / with_kind: [19:18] u8,
        /// Packets a microframe; for a periodic split the core's immediate retries.
        count / with_count: [21:20] u8,
        /// Device address.
        address / with_address: [28:22] u8,
        /// A periodic transaction goes into an odd (micro)frame.
        odd_frame / with_odd_frame: [29:29] bool,
        /// Halts the channel.
        disable / with_disable: [30:30] bool,
        /// Starts the channel.
        enable / with_enable: [31:31] bool,
    }
}

register! {
    /// HCSPLT: the hub that splits.
    Hcsplt @ 0x504 {
        /// The hub's port.
        port / with_port: [6:0] u8,
        /// The hub's address.
        hub / with_hub: [13:7] u8,
        /// 3: the whole payload in one.
        position / with_position: [15:14] u8,
        /// A complete split.
        complete / with_complete: [16:16] bool,
        /// The channel splits.
        enable / with_enable: [31:31] bool,
    }
}

register! {
    /// HCINT: why a channel halted; write one to clear.
    Hcint @ 0x508 {
        /// The transfer is complete.
        complete / with_complete: [0:0] bool,
        /// The channel halted.
        halted / with_halted: [1:1] bool,
        /// The DMA met a bus error.
        bus_error / with_bus_error: [2:2] bool,
        /// STALL.
        stall / with_stall: [3:3] bool,
        /// NAK.
        nak / with_nak: [4:4] bool,
        /// ACK.
        ack / with_ack: [5:5] bool,
        /// NYET.
        nyet / with_nyet: [6:6] bool,
        /// No answer or a broken one.
        transaction_error / with_transaction_error: [7:7] bool,
        /// More data than asked for.
        babble / with_babble: [8:8] bool,
        /// A periodic transaction missed its frame.
        frame_overrun / with_frame_overrun: [9:9] bool,
        /// Data with the wrong toggle.
        toggle_error / with_toggle_error: [10:10] bool,
    }
}

register! {
    /// HCINTMSK: which bits of HCINT interrupt.
    Hcintmsk @ 0x50c {
        /// See HCINT.
        halted / with_halted: [1:1] bool,
        /// See HCINT.
        bus_error / with_bus_error: [2:2] bool,
    }
}

register! {
    /// HCTSIZ: how much a channel moves.
    Hctsiz @ 0x510 {
        /// Bytes.
        bytes / with_bytes: [18:0] u32,
        /// Packets.
        packets / with_packets: [28:19] u16,
        /// Packet identifier of the first: 0 DATA0, 2 DATA1, 3 SETUP.
        identifier / with_identifier: [30:29] u8,
        /// Ask by PING first.
        ping / with_ping: [31:31] bool,
    }
}

register! {
    /// HCDMA: where the data is; a multiple of four.
    Hcdma @ 0x514 {
        /// The bus address.
        address / with_address: [31:0] u32,
    }
}

register! {
    /// PCGCTL: power and clock gating; 0 lets all run.
    Pcgctl @ 0xe00 {
        /// The PHY's clock is stopped.
        stop_clock / with_stop_clock: [0:0] bool,
    }
}
