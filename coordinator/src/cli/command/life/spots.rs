//! Hot spots of the head and its gauges, with their lives under the operation of a plan.
use super::{
    body::Body,
    options::LifePlan,
    place::{Bearing, distance, is_at_inner_edge, nearest},
};
use discrepancy::estimate::neighbourhood::{Neighbourhood, QuantityInterval};
use fatigue::{Assessment, LoadPeriod, PointDamage, Residue, StressCycle, cycles};
use protocol::pumping_unit::{HeadLoads, Simulation};
use report::pumping_unit::SECTOR_DEG;

/// Days of a year, in which lives are given.
const DAYS: f64 = 365.25;
/// Number of hot spots that are listed.
const LISTED: usize = 10;
/// Least distance between two hot spots \[m\]: what lies closer belongs to the worse one.
const APART_M: f64 = 0.05;
/// Largest load factor that is searched.
const LARGEST_FACTOR: f64 = 1e3;

/// Individual with its simulations under the conditions of the plan.
pub(super) struct Variant<'a> {
    pub(super) name: &'a str,
    pub(super) simulations: Vec<Simulation>,
}

/// Life of one place.
#[derive(Clone, Debug)]
pub(super) struct Life {
    /// Years until the damage is one; infinite where no cycle does any.
    pub(super) years: f64,
    /// 95 % interval of the life's logarithm, which is taken as linear in the unknowns; `None` where there is none.
    pub(super) log_interval: Option<QuantityInterval>,
    /// Smallest and largest life over this and the other fits that the run saw; `None` without any.
    pub(super) over_fits: Option<[f64; 2]>,
    /// Damage of one revolution under each condition.
    pub(super) damage_per_revolution: Vec<f64>,
    /// Share of the damage that each condition has; zero without damage.
    pub(super) shares: Vec<f64>,
    /// Factor on all stresses with which the place lives as long as the target; `None` where no factor up to
    /// [`LARGEST_FACTOR`] does.
    pub(super) load_factor: Option<f64>,
    /// Largest range of the counted stress \[MPa\].
    pub(super) range_mpa: f64,
}

impl Life {
    /// Returns the 95 % interval of the life from the covariance of the unknowns \[years\]; `None` where there is none.
    pub(super) fn ci95(&self) -> Option<[f64; 2]> {
        let half = self.log_interval?.half_width;
        Some([self.years * (-half).exp(), self.years * half.exp()])
    }
}

/// Point of the surface where the life is shortest.
#[derive(Clone, Debug)]
pub(super) struct HotSpot {
    pub(super) place_m: [f64; 3],
    pub(super) bearing: Option<Bearing>,
    pub(super) inner_edge: bool,
    pub(super) life: Life,
    /// Largest equivalent stress of von Mises \[MPa\].
    pub(super) von_mises_mpa: f64,
}

/// Lives of one variant.
#[derive(Clone, Debug)]
pub(super) struct AssessedVariant {
    pub(super) name: String,
    /// Hot spots, shortest life first.
    pub(super) hot_spots: Vec<HotSpot>,
    /// Lives at gauges 1 to 4, by their simulated readings.
    pub(super) gauges: Vec<Life>,
    /// Life of each point of the surface \[years\]; NaN where none is assessed.
    pub(super) years: Vec<f64>,
    /// For each condition, the share of the first hot spot's damage in each sector of the revolution.
    pub(super) sectors: Vec<Vec<f64>>,
}

/// Further individuals over which lives of the last variant spread.
#[derive(Clone, Copy, Default)]
pub(super) struct Spread<'a> {
    /// Fits of other families that the run saw.
    pub(super) others: &'a [Variant<'a>],
    /// Individuals about the optimum, with their simulations; `None` where lives have no interval.
    pub(super) about: Option<(&'a Neighbourhood, &'a [Variant<'a>])>,
}

/// Assesses the gauges and, where there is a mesh, the surface for each variant, with the spread of the last.
pub(super) fn assess(
    body: Option<&Body>,
    plan: &LifePlan,
    variants: &[Variant<'_>],
    spread: &Spread<'_>,
) -> Vec<AssessedVariant> {
    let last = variants.len().saturating_sub(1);
    let each = variants.iter().enumerate();
    each.map(|(k, variant)| {
        let spread = if k == last {
            *spread
        } else {
            Spread::default()
        };
        assess_variant(body, plan, variant, &spread)
    })
    .collect()
}

fn assess_variant(
    body: Option<&Body>,
    plan: &LifePlan,
    variant: &Variant<'_>,
    spread: &Spread<'_>,
) -> AssessedVariant {
    let about = spread.about.map_or(&[][..], |(_, own)| own);
    let neighbourhood = spread.about.map(|(own, _)| own);
    let gauge = |gauge: usize| {
        let counted = |variant: &Variant<'_>| -> Vec<Vec<StressCycle>> {
            let curves = variant.simulations.iter().map(|own| &own.gauge_mpa[gauge]);
            curves
                .map(|curve| cycles(curve, Residue::Repeating))
                .collect()
        };
        let years = |other: &Variant<'_>| years(plan, &counted(other), 1.0);
        let all = [spread.others, about];
        let all = all.map(|all| all.iter().map(years).collect());
        life(plan, &counted(variant), all, neighbourhood)
    };
    let gauges = (0..4).map(gauge).collect();
    let assessed = AssessedVariant {
        name: variant.name.to_owned(),
        hot_spots: Vec::new(),
        gauges,
        years: Vec::new(),
        sectors: Vec::new(),
    };
    match body {
        Some(body) => with_surface(assessed, body, plan, variant, spread),
        None => assessed,
    }
}

/// Adds the lives of the surface to those of the gauges.
fn with_surface(
    assessed: AssessedVariant,
    body: &Body,
    plan: &LifePlan,
    variant: &Variant<'_>,
    spread: &Spread<'_>,
) -> AssessedVariant {
    let (surface, of_variant) = (body.fatigue(), periods(plan, variant));
    let mut damages = surface.damage(
        &body.points,
        &of_variant,
        (&plan.assessment, plan.criterion),
    );
    damages.sort_by(|a, b| {
        let range = || b.largest_range.total_cmp(&a.largest_range);
        b.damage().total_cmp(&a.damage()).then_with(range)
    });
    let worst = apart(body, &damages);
    let mut of_points = vec![f64::NAN; body.surface().places_m.len()];
    for own in &damages {
        of_points[own.point] = 1.0 / (DAYS * own.damage());
    }
    let sectors = worst.first().map(|own| {
        let counted = of_variant.iter();
        let counted = counted.map(|period| surface.cycles(own.point, period, own.plane.as_ref()));
        shares_by_sector(plan, &counted.collect::<Vec<_>>(), variant)
    });
    let about = spread.about.map_or(&[][..], |(_, own)| own);
    let [of_others, of_about] = [spread.others, about].map(|all| all_periods(plan, all));
    let spot = |own: &&PointDamage| {
        let place_m = body.place_m(own.point);
        let counted = |periods: &[LoadPeriod<'_>]| -> Vec<Vec<StressCycle>> {
            let each = periods.iter();
            each.map(|period| surface.cycles(own.point, period, own.plane.as_ref()))
                .collect()
        };
        let years = |periods: &Vec<LoadPeriod<'_>>| years(plan, &counted(periods), 1.0);
        HotSpot {
            place_m,
            bearing: nearest(&body.pins, &place_m),
            inner_edge: is_at_inner_edge(body.surface(), own.point),
            life: life(
                plan,
                &counted(&of_variant),
                [&of_others, &of_about].map(|all| all.iter().map(years).collect()),
                spread.about.map(|(own, _)| own),
            ),
            von_mises_mpa: own.largest_von_mises,
        }
    };
    AssessedVariant {
        hot_spots: worst.iter().map(spot).collect(),
        years: of_points,
        sectors: sectors.unwrap_or_default(),
        ..assessed
    }
}

/// Returns the worst of points in descending order of their damage, each at least [`APART_M`] from those before it.
fn apart<'a>(body: &Body, damages: &'a [PointDamage]) -> Vec<&'a PointDamage> {
    let mut worst: Vec<&PointDamage> = Vec::new();
    for own in damages {
        let place = body.place_m(own.point);
        let near = |other: &&PointDamage| distance(&body.place_m(other.point), &place) < APART_M;
        if worst.iter().any(near) {
            continue;
        }
        worst.push(own);
        if worst.len() == LISTED {
            break;
        }
    }
    worst
}

/// Returns the share of the damage of a day in each sector of the revolution under each condition, from the cycles of a
/// revolution; zeros without damage.
fn shares_by_sector(
    plan: &LifePlan,
    counted: &[Vec<StressCycle>],
    variant: &Variant<'_>,
) -> Vec<Vec<f64>> {
    let each = counted.iter().zip(&variant.simulations);
    let damages = each
        .zip(&plan.operations)
        .map(|((cycles, simulation), operation)| {
            let step = simulation.turn_deg.get(1).copied().unwrap_or(360.0);
            let sums = sectors(&plan.assessment, cycles, step).into_iter();
            sums.map(|own| own * operation.revolutions_per_day)
                .collect::<Vec<f64>>()
        });
    let damages: Vec<Vec<f64>> = damages.collect();
    let total: f64 = damages.iter().flatten().sum();
    let share = |own: &f64| if total > 0.0 { own / total } else { 0.0 };
    let shares = damages.iter().map(|own| own.iter().map(share).collect());
    shares.collect()
}

/// Returns the loads of each of several variants, as [`periods`].
fn all_periods<'a>(plan: &LifePlan, variants: &'a [Variant<'a>]) -> Vec<Vec<LoadPeriod<'a>>> {
    variants.iter().map(|own| periods(plan, own)).collect()
}

/// Returns the loads of a variant over one revolution of each condition, counted by the day.
fn periods<'a>(plan: &LifePlan, variant: &'a Variant<'_>) -> Vec<LoadPeriod<'a>> {
    let both = plan.operations.iter().zip(&variant.simulations);
    both.map(|(operation, simulation)| LoadPeriod {
        count: operation.revolutions_per_day,
        loads: HeadLoads::curves(&simulation.head_loads).collect(),
    })
    .collect()
}

/// Returns the damage of a revolution in each sector of the crank angle: half of that of a cycle at each of its two
/// reversals. Samples are `step_deg` apart.
fn sectors(assessment: &Assessment, cycles: &[StressCycle], step_deg: f64) -> Vec<f64> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a number of sectors, and the place among them"
    )]
    let sector = |deg: f64| (deg / SECTOR_DEG) as usize;
    let mut sums = vec![0.0; sector(360.0)];
    for cycle in cycles {
        for sample in cycle.at {
            let at = sector((sample as f64 * step_deg).rem_euclid(360.0));
            if let Some(sum) = sums.get_mut(at) {
                *sum += 0.5 * assessment.of_cycle(cycle);
            }
        }
    }
    sums
}

/// Returns the damage of one revolution by its cycles, with all stresses times a factor.
fn damage(assessment: &Assessment, cycles: &[StressCycle], factor: f64) -> f64 {
    let scaled = Assessment {
        factor: factor * assessment.factor,
        ..assessment.clone()
    };
    cycles.iter().map(|own| scaled.of_cycle(own)).sum()
}

/// Returns the years until the damage is one, from the cycles of a revolution under each condition.
fn years(plan: &LifePlan, counted: &[Vec<StressCycle>], factor: f64) -> f64 {
    let each = plan.operations.iter().zip(counted);
    let a_day: f64 = each
        .map(|(own, cycles)| own.revolutions_per_day * damage(&plan.assessment, cycles, factor))
        .sum();
    1.0 / (DAYS * a_day)
}

/// Computes the life of a place from the cycles of a revolution under each condition, and its spread from the lives
/// with the other fits and with the individuals about the optimum.
fn life(
    plan: &LifePlan,
    counted: &[Vec<StressCycle>],
    [others, about]: [Vec<f64>; 2],
    neighbourhood: Option<&Neighbourhood>,
) -> Life {
    let each: Vec<f64> = counted
        .iter()
        .map(|cycles| damage(&plan.assessment, cycles, 1.0))
        .collect();
    let years_at = |factor: f64| years(plan, counted, factor);
    let now = years_at(1.0);
    let a_day: Vec<f64> = plan
        .operations
        .iter()
        .zip(&each)
        .map(|(own, damage)| own.revolutions_per_day * damage)
        .collect();
    let total: f64 = a_day.iter().sum();
    let ranges = counted.iter().flatten().map(|own| own.range);
    let logs: Vec<f64> = about.iter().map(|own| own.ln()).collect();
    let range_over = |others: &[f64]| {
        let fold = |of: fn(f64, f64) -> f64| others.iter().copied().fold(now, of);
        [fold(f64::min), fold(f64::max)]
    };
    Life {
        years: now,
        log_interval: neighbourhood.and_then(|own| own.interval(now.ln(), &logs)),
        over_fits: (!others.is_empty()).then(|| range_over(&others)),
        shares: a_day
            .iter()
            .map(|own| if total > 0.0 { own / total } else { 0.0 })
            .collect(),
        damage_per_revolution: each,
        load_factor: load_factor(plan.target_years, &years_at),
        range_mpa: ranges.fold(0.0, f64::max),
    }
}

/// Finds the factor on all stresses with which the life is the target, by bisection of its logarithm: the life falls
/// with the factor.
fn load_factor(target: f64, years: &dyn Fn(f64) -> f64) -> Option<f64> {
    let (mut low, mut high) = (1.0 / LARGEST_FACTOR, LARGEST_FACTOR);
    if years(high) > target || years(low) < target {
        return None;
    }
    while high / low > 1.0 + 1e-9 {
        let middle = (low * high).sqrt();
        if years(middle) >= target {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}

/// Returns what a reader must know beside the lives: stresses above yield, and what ranges over fits mean.
pub(super) fn notes(plan: &LifePlan, assessed: &[AssessedVariant]) -> Vec<String> {
    let mut notes = Vec::new();
    for variant in assessed {
        let most = variant.hot_spots.iter().map(|own| own.von_mises_mpa);
        let most = most.fold(0.0, f64::max) * plan.assessment.factor;
        if most > plan.yield_mpa {
            notes.push(format!(
                "with the {} parameters the equivalent stress reaches {most:.0} MPa, more than the yield stress of {:.0} \
                 MPa: a life by linear stress does not hold there",
                variant.name, plan.yield_mpa
            ));
        }
    }
    let spots = assessed.last().map_or(&[][..], |own| &own.hot_spots);
    let at_edges = spots.iter().filter(|own| own.inner_edge).count();
    if at_edges > 0 {
        notes.push(format!(
            "{at_edges} of {} hot spots lie at an inner edge of the mesh: without the fillet or weld of the real part, stress \
             there grows as the mesh is refined, and the life falls; compare them with one another and between machines, and \
             take years from a mesh with the fillet",
            spots.len()
        ));
    }
    let lives = assessed.last().into_iter().flat_map(|own| {
        let spots = own.hot_spots.iter().map(|spot| &spot.life);
        spots.chain(&own.gauges)
    });
    let mut intervals = lives.filter_map(|life| life.log_interval);
    notes.extend(intervals.find_map(|own| own.doubt()));
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_load_factor_gives_the_target() {
        let years = |factor: f64| 160.0 / factor.powi(3);
        let found = load_factor(20.0, &years).unwrap();
        assert!((found - 2.0).abs() < 1e-6);
        assert_eq!(load_factor(20.0, &|_| f64::INFINITY), None);
        assert_eq!(load_factor(20.0, &|_| 1.0), None);
    }
}
