//! Random passive machines: chains of one to three masses on springs; one mass hits a stop.

use std::f64::consts::TAU;
use std::fmt;
use std::fmt::Write as _;

use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// Spring with backlash, on both sides.
    Play,
    /// Spring with backlash, and a damper that acts in contact.
    DampedPlay,
    OneSided,
    /// One-sided spring with the Hertzian exponent 3/2.
    Hertz,
    Impact,
}

/// Random machine with its motion. The position of the stop is computed from a motion without the stop.
#[derive(Clone, Debug)]
pub struct Machine {
    name: String,
    masses: Vec<f64>,
    /// Spring constants, N/m; the first spring is connected to ground.
    springs: Vec<f64>,
    /// Cubic stiffness of the first spring, N/m^3.
    hardening: f64,
    pub stop: Stop,
    /// Stiffness of the stop relative to the first spring.
    pub stiffness_ratio: f64,
    /// Index of the mass that hits the stop.
    pub at: usize,
    /// Coulomb friction of the last mass, N.
    friction: f64,
    restitution: f64,
    /// Initial coordinates, then rates, m and m/s.
    pub initial: Vec<f64>,
    /// Penetration of the turning point beyond the stop, relative to the amplitude.
    pub depth: f64,
    /// Number from 0 to 1 that selects a turning point.
    pub choice: f64,
    /// Duration of the motion, s.
    pub duration: f64,
}

struct Numbers(SplitMix64);

impl Numbers {
    /// Draws a uniform number in [0, 1).
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * 0.5_f64.powi(53)
    }

    fn draw_between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Draws a number with a uniform logarithm.
    fn scale(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    fn happens(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count - 1)
    }
}

impl Machine {
    /// Draws machine number `place` of a seed.
    pub fn draw(seed: u64, place: usize) -> Self {
        let mut mixed = SplitMix64::seed_from_u64(seed);
        let first = mixed.next_u64();
        let mut numbers = Numbers(SplitMix64::seed_from_u64(first.wrapping_add(place as u64)));
        let count = 1 + numbers.below(3);
        let masses: Vec<f64> = (0..count).map(|_| numbers.scale(0.1, 10.0)).collect();
        let springs: Vec<f64> = (0..count).map(|_| numbers.scale(1.0, 1000.0)).collect();
        let size = numbers.scale(1e-4, 10.0);
        let laws = [
            Stop::Play,
            Stop::DampedPlay,
            Stop::OneSided,
            Stop::Hertz,
            Stop::Impact,
        ];
        let stop = laws[numbers.below(laws.len())];
        let hardening = match numbers.happens(0.3) {
            true => springs[0] / (size * size) * numbers.draw_between(0.1, 2.0),
            false => 0.0,
        };
        // Solvers do not support sticking friction together with impacts.
        let friction = match numbers.happens(0.3) && stop != Stop::Impact {
            true => springs[0] * size * numbers.scale(1e-3, 5e-2),
            false => 0.0,
        };
        let mut initial: Vec<f64> = (0..2 * count)
            .map(|_| numbers.draw_between(-1.0, 1.0))
            .collect();
        let frequency = (springs[0] / masses.iter().sum::<f64>()).sqrt();
        let at = numbers.below(count);
        if stop == Stop::Impact {
            initial[at] = 0.0;
        }
        for (index, entry) in initial.iter_mut().enumerate() {
            *entry *= if index < count {
                size
            } else {
                size * frequency
            };
        }
        let sign = if numbers.happens(0.5) { 1.0 } else { -1.0 };
        Self {
            name: format!("seed {seed}, machine {place}"),
            at,
            stiffness_ratio: numbers.scale(1e2, 1e6),
            restitution: numbers.draw_between(0.1, 1.0),
            depth: sign * numbers.scale(1e-12, 1e-2),
            choice: numbers.unit(),
            duration: numbers.draw_between(5.0, 12.0) * TAU / frequency,
            masses,
            springs,
            hardening,
            stop,
            friction,
            initial,
        }
    }

    pub fn count(&self) -> usize {
        self.masses.len()
    }

    pub fn is_two_sided(&self) -> bool {
        matches!(self.stop, Stop::Play | Stop::DampedPlay)
    }

    /// Returns the specification with the stop at `place` (m).
    pub fn specification(&self, place: f64) -> String {
        let mut text = "[model]\nname = \"grazing\"\n[parameters]\n".to_owned();
        let _ = writeln!(text, "b = {{ value = {place:e}, unit = \"m\" }}");
        let _ = writeln!(
            text,
            "e = {{ value = {:e}, unit = \"1\" }}",
            self.restitution
        );
        let _ = writeln!(text, "F = {{ value = {:e}, unit = \"N\" }}", self.friction);
        let hardening = self.hardening;
        let _ = writeln!(text, "h = {{ value = {hardening:e}, unit = \"N/m^3\" }}");
        let stiffness = self.stiffness_ratio * self.springs[0];
        let _ = writeln!(text, "K = {{ value = {stiffness:e}, unit = \"N/m\" }}");
        // The damping is a tenth of the critical damping of the contact.
        let damping = 0.2 * (stiffness * self.masses[self.at]).sqrt();
        let _ = writeln!(text, "c = {{ value = {damping:e}, unit = \"N s/m\" }}");
        let hertz = stiffness / self.amplitude().sqrt();
        let _ = writeln!(text, "H = {{ value = {hertz:e}, unit = \"N/m^(3/2)\" }}");
        for (index, (mass, spring)) in self.masses.iter().zip(&self.springs).enumerate() {
            let _ = writeln!(text, "m_{index} = {{ value = {mass:e}, unit = \"kg\" }}");
            let _ = writeln!(text, "k_{index} = {{ value = {spring:e}, unit = \"N/m\" }}");
        }
        text.push_str("[coordinates]\n");
        for index in 0..self.count() {
            let _ = writeln!(text, "x_{index} = {{ unit = \"m\" }}");
        }
        text.push_str("[kinetic]\n");
        for index in 0..self.count() {
            let _ = writeln!(text, "T_{index} = \"1/2*m_{index}*dot(x_{index})^2\"");
        }
        self.write_forces(&mut text);
        text
    }

    fn write_forces(&self, text: &mut String) {
        let x = format!("x_{}", self.at);
        text.push_str("[potential]\nground = \"1/2*k_0*x_0^2\"\n");
        if self.hardening > 0.0 {
            text.push_str("cubic = \"1/4*h*x_0^4\"\n");
        }
        for index in 1..self.count() {
            let before = index - 1;
            let _ = writeln!(
                text,
                "V_{index} = \"1/2*k_{index}*(x_{index} - x_{before})^2\""
            );
        }
        let _ = match self.stop {
            Stop::Play => writeln!(text, "stop = \"1/2*K*deadzone({x}, b)^2\""),
            Stop::DampedPlay => writeln!(
                text,
                "stop = \"1/2*K*deadzone({x}, b)^2\"\n[dissipation]\nstop = \
                 \"1/2*c*contact({x}, b)*dot({x})^2\""
            ),
            Stop::OneSided => writeln!(text, "stop = \"1/2*K*max({x} - b, 0)^2\""),
            Stop::Hertz => writeln!(text, "stop = \"2/5*H*max({x} - b, 0)^(5/2)\""),
            Stop::Impact => writeln!(
                text,
                "[impacts]\nstop = {{ when = \"b - {x}\", restitution = \"e\" }}"
            ),
        };
        if self.friction > 0.0 {
            let last = self.count() - 1;
            let _ = writeln!(
                text,
                "[forces]\nfriction = {{ on = \"x_{last}\", value = \"-F*sign(dot(x_{last}))\" }}"
            );
        }
    }

    fn amplitude(&self) -> f64 {
        let count = self.count();
        let frequency = (self.springs[0] / self.masses.iter().sum::<f64>()).sqrt();
        let rates = self.initial[count..].iter().map(|rate| rate / frequency);
        let all = self.initial[..count].iter().copied().chain(rates);
        all.map(f64::abs).fold(0.0, f64::max)
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} ({} masses, {:?}, stop {:.0e} times the spring, turning point {:.0e} beyond{}{})",
            self.name,
            self.count(),
            self.stop,
            self.stiffness_ratio,
            self.depth,
            if self.friction > 0.0 {
                ", friction"
            } else {
                ""
            },
            if self.hardening > 0.0 { ", cubic" } else { "" },
        )
    }
}
