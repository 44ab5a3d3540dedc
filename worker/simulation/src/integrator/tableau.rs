//! Coefficients of singly diagonally implicit Runge-Kutta methods with an explicit first stage.

/// Coefficients of a stiffly accurate method, whose last stage is the result.
#[derive(Debug)]
pub struct Tableau {
    /// Name of the method in case files.
    pub name: &'static str,
    /// Order of accuracy of the method.
    pub order: u32,
    /// Times of the stages as shares of the step; the first is 0, the last 1.
    pub nodes: &'static [f64],
    /// Stage matrix below the diagonal, one list per stage; that of the first stage is empty, that of the
    /// last one holds the weights of the result except the last weight.
    pub rows: &'static [&'static [f64]],
    /// Diagonal entry of the stage matrix, equal for all implicit stages.
    pub diagonal: f64,
    /// Weights of the stages in the embedded formula that estimates the error.
    pub embedded: &'static [f64],
    /// Order of the error estimate with respect to the step size.
    pub error_order: f64,
}

const GAMMA: f64 = 2.0 - std::f64::consts::SQRT_2;
const W: f64 = 0.25 * std::f64::consts::SQRT_2;

/// TR-BDF2: trapezoidal rule to `t + (2 - sqrt 2) h`, then BDF2; L-stable, second order, third-order error
/// estimate. Hosea and Shampine (1996).
pub static TR_BDF2: Tableau = Tableau {
    name: "tr-bdf2",
    order: 2,
    nodes: &[0.0, GAMMA, 1.0],
    rows: &[&[], &[0.5 * GAMMA], &[W, W]],
    diagonal: 0.5 * GAMMA,
    embedded: &[(1.0 - W) / 3.0, (3.0 * W + 1.0) / 3.0, GAMMA / 6.0],
    error_order: 3.0,
};

/// Implicit part of ARK4(3)6L\[2\]SA: L-stable, fourth order, embedded third-order formula. Kennedy and
/// Carpenter (2003).
pub static ESDIRK4: Tableau = Tableau {
    name: "esdirk4",
    order: 4,
    nodes: &[0.0, 0.5, 83.0 / 250.0, 31.0 / 50.0, 17.0 / 20.0, 1.0],
    rows: &[
        &[],
        &[0.25],
        &[8611.0 / 62500.0, -1743.0 / 31250.0],
        &[
            5012029.0 / 34652500.0,
            -654441.0 / 2922500.0,
            174375.0 / 388108.0,
        ],
        &[
            15267082809.0 / 155376265600.0,
            -71443401.0 / 120774400.0,
            730878875.0 / 902184768.0,
            2285395.0 / 8070912.0,
        ],
        &[
            82889.0 / 524892.0,
            0.0,
            15625.0 / 83664.0,
            69875.0 / 102672.0,
            -2260.0 / 8211.0,
        ],
    ],
    diagonal: 0.25,
    embedded: &[
        4586570599.0 / 29645900160.0,
        0.0,
        178811875.0 / 945068544.0,
        814220225.0 / 1159782912.0,
        -3700637.0 / 11593932.0,
        61727.0 / 225920.0,
    ],
    error_order: 4.0,
};

/// All singly diagonally implicit Runge-Kutta methods offered.
pub static CATALOGUE: [&Tableau; 2] = [&TR_BDF2, &ESDIRK4];

impl Tableau {
    /// Returns the weight with which stage `i` enters the result of the step.
    pub fn weight(&self, i: usize) -> f64 {
        let last = self.nodes.len() - 1;
        if i == last {
            self.diagonal
        } else {
            self.rows[last][i]
        }
    }

    /// Returns the number of stages, including the explicit first one.
    pub const fn stages(&self) -> usize {
        self.nodes.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn full(t: &Tableau) -> Vec<Vec<f64>> {
        let s = t.stages();
        (0..s)
            .map(|i| {
                let mut row = vec![0.0; s];
                row[..t.rows[i].len()].copy_from_slice(t.rows[i]);
                if i > 0 {
                    row[i] = t.diagonal;
                }
                row
            })
            .collect()
    }

    #[test]
    fn order_conditions_hold() {
        for t in CATALOGUE {
            let (a, c) = (full(t), t.nodes);
            let s = t.stages();
            for i in 0..s {
                assert!(
                    (a[i].iter().sum::<f64>() - c[i]).abs() < 1e-15,
                    "{} row {i}",
                    t.name
                );
            }
            let conditions = |b: &[f64]| -> Vec<(u32, f64)> {
                let sum = |f: &dyn Fn(usize) -> f64| (0..s).map(|i| b[i] * f(i)).sum::<f64>();
                let ac = |i: usize, p: i32| (0..s).map(|j| a[i][j] * c[j].powi(p)).sum::<f64>();
                let aac = |i: usize| (0..s).map(|j| a[i][j] * ac(j, 1)).sum::<f64>();
                vec![
                    (1, sum(&|_| 1.0) - 1.0),
                    (2, sum(&|i| c[i]) - 1.0 / 2.0),
                    (3, sum(&|i| c[i] * c[i]) - 1.0 / 3.0),
                    (3, sum(&|i| ac(i, 1)) - 1.0 / 6.0),
                    (4, sum(&|i| c[i].powi(3)) - 1.0 / 4.0),
                    (4, sum(&|i| c[i] * ac(i, 1)) - 1.0 / 8.0),
                    (4, sum(&|i| ac(i, 2)) - 1.0 / 12.0),
                    (4, sum(&|i| aac(i)) - 1.0 / 24.0),
                ]
            };
            let weights: Vec<f64> = (0..s).map(|i| t.weight(i)).collect();
            for (order, defect) in conditions(&weights) {
                assert_eq!(
                    defect.abs() < 1e-14,
                    order <= t.order,
                    "{} order {order}: {defect}",
                    t.name
                );
            }
            for (order, defect) in conditions(t.embedded) {
                assert!(
                    order > 3 || defect.abs() < 1e-14,
                    "{} embedded {order}: {defect}",
                    t.name
                );
            }
        }
    }
}
