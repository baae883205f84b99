//! A number with its first two time derivatives.

use std::ops::{Add, Mul, Sub};

use nalgebra::Vector3;

/// Value, first and second derivative by time; products and roots follow Leibniz and the chain rule exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Series(pub [f64; 3]);

impl Series {
    pub fn constant(value: f64) -> Self {
        Self([value, 0.0, 0.0])
    }

    /// `f(self)` from `f`, `f'` and `f''` at the value.
    fn map(self, [f, df, ddf]: [f64; 3]) -> Self {
        let [_, d, dd] = self.0;
        Self([f, df * d, ddf * d * d + df * dd])
    }

    pub fn sqrt(self) -> Self {
        let root = self.0[0].sqrt();
        self.map([root, 0.5 / root, -0.25 / (root * self.0[0])])
    }

    pub fn recip(self) -> Self {
        let inverse = self.0[0].recip();
        self.map([inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse])
    }

    pub fn cos_sin(self) -> [Self; 2] {
        let (sin, cos) = self.0[0].sin_cos();
        [self.map([cos, -sin, -cos]), self.map([sin, cos, -sin])]
    }
}

impl Add for Series {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Series {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul for Series {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ([a, da, dda], [b, db, ddb]) = (self.0, other.0);
        Self([a * b, da * b + a * db, dda * b + 2.0 * da * db + a * ddb])
    }
}

/// A vector with its first two time derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SeriesVector(pub [Series; 3]);

impl SeriesVector {
    pub fn new(value: &Vector3<f64>, first: &Vector3<f64>, second: &Vector3<f64>) -> Self {
        Self(std::array::from_fn(|i| Series([value[i], first[i], second[i]])))
    }

    pub fn dot(&self, other: &Self) -> Series {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }

    pub fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    pub fn scaled(&self, by: Series) -> Self {
        Self(self.0.map(|x| x * by))
    }

    pub fn plus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    /// The unit vector; `None` where the length is zero or not finite.
    pub fn normalised(&self) -> Option<Self> {
        let squared = self.dot(self);
        let usable = squared.0[0] > f64::MIN_POSITIVE && squared.0[0].is_finite();
        usable.then(|| self.scaled(squared.sqrt().recip()))
    }

    /// The derivative of this order: 0 is the value.
    pub fn order(&self, order: usize) -> Vector3<f64> {
        Vector3::from(self.0.map(|x| x.0[order]))
    }
}
