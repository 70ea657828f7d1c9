//! Instructions that say something to the bus when they are fetched.

/// What one says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Hint {
    /// The core sleeps: WFI, WFE.
    Wait,
    /// What was written before comes before what follows: DSB, DMB, of any kind.
    Barrier,
    /// An exclusive access comes: LDREX, STREX and their kin.
    Exclusive,
}

/// Tells barriers' words but for their kind; ISB has a bit more.
const BARRIER_MASK: u32 = 0xFFFF_FFE0;

/// Returns what a word of ARM code says.
#[inline]
pub(super) fn of(word: u32) -> Option<Hint> {
    if word & 0x0FFF_FFFE == 0x0320_F002 {
        Some(Hint::Wait)
    } else if word & 0x0F80_00F0 == 0x0180_0090 && word >> 28 != 0xF {
        Some(Hint::Exclusive)
    } else {
        (word & BARRIER_MASK == 0xF57F_F040).then_some(Hint::Barrier)
    }
}

/// Returns what a half word of Thumb code says, after the one before.
#[inline]
pub(super) fn of_thumb(before: u32, half: u32) -> Option<Hint> {
    // Of two halves, the second: of words, or of bytes, half words and double words.
    let exclusive = before & 0xFFE0 == 0xE840 || before & 0xFFE0 == 0xE8C0 && half & 0xC0 == 0x40;
    if exclusive {
        Some(Hint::Exclusive)
    } else if half & 0xFFEF == 0xBF20 {
        Some(Hint::Wait)
    } else {
        ((before << 16 | half) & BARRIER_MASK == 0xF3BF_8F40).then_some(Hint::Barrier)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exclusive_accesses_are_known_in_both_instruction_sets() {
        // LDREX, STREX, LDREXB, STREXBNE, LDREXD; MUL, SWP, LDRH, STRD.
        let exclusive = [0xE190_1F9F, 0xE180_2F91, 0xE1D0_1F9F, 0x11C0_2F91, 0xE1B0_2F9F];
        assert_eq!(exclusive.map(of), [Some(Hint::Exclusive); 5]);
        assert_eq!([0xE000_0291, 0xE100_1092, 0xE1D0_10B0, 0xE1C0_00F0].map(of), [None; 4]);
        // The same; TBB, STRD.
        let thumb = [(0xE850, 0x1F00), (0xE840, 0x1200), (0xE8D0, 0x1F4F), (0xE8C0, 0x1F42), (0xE8D0, 0x237F)];
        assert_eq!(thumb.map(|(before, half)| of_thumb(before, half)), [Some(Hint::Exclusive); 5]);
        assert_eq!([(0xE8DF, 0xF001), (0xE9C0, 0x1240)].map(|(before, half)| of_thumb(before, half)), [None; 2]);
    }

    #[test]
    fn waits_and_barriers_are_known_in_both_instruction_sets() {
        // WFE, WFI, NOP; DSB SY, DMB ISH, ISB.
        assert_eq!([0xE320_F002, 0xE320_F003, 0xE320_F000].map(of), [Some(Hint::Wait), Some(Hint::Wait), None]);
        let barriers = [0xF57F_F04F, 0xF57F_F05B, 0xF57F_F06F].map(of);
        assert_eq!(barriers, [Some(Hint::Barrier), Some(Hint::Barrier), None]);
        assert_eq!([0xBF20, 0xBF30, 0xBF00].map(|half| of_thumb(0, half)), [Some(Hint::Wait), Some(Hint::Wait), None]);
        let barriers = [0x8F4F, 0x8F5B, 0x8F6F].map(|half| of_thumb(0xF3BF, half));
        assert_eq!(barriers, [Some(Hint::Barrier), Some(Hint::Barrier), None]);
        assert_eq!(of_thumb(0x4608, 0x8F4F), None);
    }
}
