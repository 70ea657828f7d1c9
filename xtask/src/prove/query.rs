//! What the solver is asked, made of the formulas that Yosys writes.
//!
//! Yosys' `write_smt2` gives a sort of states and, by the module's name, predicates: `_i` a state after
//! power-on, `_u` what is assumed of a state, `_t` that one state follows on another, `_a N` an
//! assertion, `_c N` something to be reached. Comments say where each stands in the source.

use std::fmt::{self, Write as _};

use anyhow::{Context, ensure};

/// A module's formulas.
#[derive(Debug)]
pub(super) struct Formulas<'a> {
    top: &'a str,
    text: &'a str,
    assertions: Vec<Claim<'a>>,
    covers: Vec<Claim<'a>>,
}

/// An assertion or a cover: its number and its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Claim<'a> {
    number: u32,
    place: &'a str,
}

/// A question, by what it decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Goal<'a> {
    /// The assertion at a place holds after power-on.
    Base(&'a str),
    /// The assertion at a place holds after clocks in which all held.
    Step(&'a str),
    /// What stands at a place can happen.
    Reached(&'a str),
}

impl fmt::Display for Goal<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Goal::Base(place) => write!(f, "the assertion at {place} does not hold after power-on"),
            Goal::Step(place) => write!(f, "the assertion at {place} does not follow from the clocks before"),
            Goal::Reached(place) => write!(f, "what {place} wants to be possible is not reached: too much is assumed"),
        }
    }
}

impl<'a> Formulas<'a> {
    /// Reads which assertions and covers there are.
    ///
    /// # Errors
    /// When a comment of Yosys' is not as expected.
    pub(super) fn new(top: &'a str, text: &'a str) -> anyhow::Result<Self> {
        let claims = |kind: &str| -> anyhow::Result<Vec<Claim<'a>>> {
            let prefix = format!("; yosys-smt2-{kind} ");
            let lines = text.lines().filter_map(|line| line.strip_prefix(&prefix));
            let mut claims = lines
                .map(|line| Claim::new(line).with_context(|| format!("Yosys wrote `{prefix}{line}`")))
                .collect::<anyhow::Result<Vec<_>>>()?;
            // In the source's order, in which one follows more easily on those before.
            claims.sort_by_key(|claim| claim.order());
            Ok(claims)
        };
        ensure!(text.contains(&format!("|{top}_t|")), "Yosys wrote no formulas for {top}");
        Ok(Self { top, text, assertions: claims("assert")?, covers: claims("cover")? })
    }

    /// Returns what each answer to the query is about, in its order.
    pub(super) fn goals(&self) -> Vec<Goal<'a>> {
        let bases = self.assertions.iter().map(|claim| Goal::Base(claim.place));
        let steps = self.assertions.iter().map(|claim| Goal::Step(claim.place));
        bases.chain(steps).chain(self.covers.iter().map(|claim| Goal::Reached(claim.place))).collect()
    }

    /// Returns the questions: is there a state that breaks an assertion, in the first `depth` clocks or
    /// after `depth` clocks that break none; is there a way of `reach` clocks to what must be possible.
    pub(super) fn query(&self, depth: usize, reach: usize) -> String {
        let top = self.top;
        let mut query = format!("(set-logic ALL)\n{}\n", self.text);
        let powered_on = format!("(assert (|{top}_i| s0))\n");
        query += "(push 1)\n";
        query += &(self.path(depth) + &powered_on);
        for Claim { number, .. } in &self.assertions {
            let broken: String = (0..depth).map(|clock| format!(" (not (|{top}_a {number}| s{clock}))")).collect();
            query += &question(&format!("(or false{broken})"));
        }
        query += "(pop 1)\n(push 1)\n";
        query += &self.path(depth + 1);
        for clock in 0..depth {
            let _ = writeln!(query, "(assert (|{top}_a| s{clock}))");
        }
        for Claim { number, .. } in &self.assertions {
            query += &question(&format!("(not (|{top}_a {number}| s{depth}))"));
            // Proven, so it helps those behind it.
            let _ = writeln!(query, "(assert (|{top}_a {number}| s{depth}))");
        }
        query += "(pop 1)\n(push 1)\n";
        query += &(self.path(reach) + &powered_on);
        for Claim { number, .. } in &self.covers {
            let reached: String = (0..reach).map(|clock| format!(" (|{top}_c {number}| s{clock})")).collect();
            query += &question(&format!("(or false{reached})"));
        }
        query + "(pop 1)\n"
    }

    /// Returns states that follow on each other, with what is assumed of them.
    fn path(&self, clocks: usize) -> String {
        let top = self.top;
        let mut path = String::new();
        for clock in 0..clocks {
            let _ = writeln!(path, "(declare-fun s{clock} () |{top}_s|)\n(assert (|{top}_u| s{clock}))");
            if let Some(before) = clock.checked_sub(1) {
                let _ = writeln!(path, "(assert (|{top}_t| s{before} s{clock}))");
            }
        }
        path
    }
}

fn question(formula: &str) -> String {
    format!("(push 1)\n(assert {formula})\n(check-sat)\n(pop 1)\n")
}

impl<'a> Claim<'a> {
    /// Reads a number, a name and a place.
    fn new(line: &'a str) -> Option<Self> {
        let (number, rest) = line.split_once(' ')?;
        let (_, place) = rest.rsplit_once(' ')?;
        Some(Self { number: number.parse().ok()?, place })
    }

    /// Line and column, then the number: a loop's assertions share a place.
    fn order(&self) -> (u32, u32, u32) {
        let begin = self.place.rsplit_once(':').and_then(|(_, range)| range.split('-').next());
        let (line, column) = begin.and_then(|begin| begin.split_once('.')).unwrap_or(("0", "0"));
        (line.parse().unwrap_or(0), column.parse().unwrap_or(0), self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "; yosys-smt2-assert 0 $7 rtl/a.sv:20.3-20.9\n; yosys-smt2-assert 1 $8 rtl/a.sv:9.5-9.9\n\
                        ; yosys-smt2-cover 0 $9 rtl/a.sv:30.1-30.9\n(define-fun |m_t| ...)\n";

    #[test]
    fn questions_come_in_the_order_of_the_goals() {
        let formulas = Formulas::new("m", TEXT).expect("it is whole");
        let (early, late) = ("rtl/a.sv:9.5-9.9", "rtl/a.sv:20.3-20.9");
        let goals = formulas.goals();
        let expected = [
            Goal::Base(early),
            Goal::Base(late),
            Goal::Step(early),
            Goal::Step(late),
            Goal::Reached("rtl/a.sv:30.1-30.9"),
        ];
        assert_eq!(goals, expected);
        assert_eq!(formulas.query(2, 3).matches("(check-sat)").count(), goals.len());
    }

    #[test]
    fn the_step_starts_anywhere_and_the_others_at_power_on() {
        let query = Formulas::new("m", TEXT).expect("it is whole").query(1, 4);
        let parts: Vec<&str> = query.split("(pop 1)\n(push 1)\n(declare-fun s0").collect();
        let [base, step, reach] = *parts.as_slice() else { panic!("three parts in {query}") };
        assert!(base.contains("(|m_i| s0)") && reach.contains("(|m_i| s0)") && !step.contains("|m_i|"));
        assert!(step.contains("(assert (|m_a| s0))") && !step.contains("(assert (|m_a| s1))"), "{step}");
        assert!(step.contains("(assert (not (|m_a 1| s1)))"), "{step}");
        assert!(reach.contains("(or false (|m_c 0| s0) (|m_c 0| s1) (|m_c 0| s2) (|m_c 0| s3))"), "{reach}");
    }

    #[test]
    fn formulas_of_another_module_are_an_error() {
        let error = Formulas::new("n", TEXT).expect_err("not that module").to_string();
        assert!(error.contains("no formulas for n"), "{error}");
        assert!(Formulas::new("m", "; yosys-smt2-assert x\n|m_t|").is_err());
    }
}
