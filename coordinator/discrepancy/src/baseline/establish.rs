//! Construction of the baseline: noise, global search, recalibration, numerical check, and fit in the final
//! metric.
use crate::baseline::base::Baseline;
use crate::baseline::input_error::input_errors;
use crate::baseline::{discretisation_check, global_start, narrow_minimum, recalibrate};
use crate::inputs::Inputs;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::whitened::WhitenedRecord;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::inactive_unknowns::InactiveUnknowns;
use crate::model::nuisance_parameter::NuisanceParameter;
use crate::model::unknowns::{FittedModel, Point};
use crate::thresholds::BEYOND;
use nalgebra::DVector;
use record::basis::ChannelGroup;
use record::metric::Metric;
use record::noise::Noise;
use record::{Curves, Record};

/// Reason why no baseline could be constructed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BaselineError {
    /// No fit of the model without effects could be simulated to its end.
    NothingCompletes,
    /// The budget of simulations was used up before the recalibration.
    RanOut,
}

impl BaselineError {
    /// Returns in words why no baseline could be constructed.
    pub(crate) const fn reason(self) -> &'static str {
        match self {
            Self::NothingCompletes => {
                "no point near the recommended parameters completes its simulation"
            }
            Self::RanOut => "the budget of the recalibration is used up: nothing was tested",
        }
    }
}

/// Constructs the baseline: noise, global search, recalibration, numerical check, final metric and final fit;
/// returns the reason if that is impossible.
pub(crate) async fn establish<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    record: Record,
) -> Result<Result<Baseline, BaselineError>, L::Error> {
    let highest = inputs.thresholds.orders;
    let own = WhitenedRecord::under_own_noise(record.clone(), highest, inputs.usual.clone());
    let mut experiments = Experiments {
        lab: &mut *lab,
        on: &own,
        stage: Stage::Basin,
    };
    let Some(first) = first_fit(&mut experiments, inputs).await? else {
        return Ok(Err(BaselineError::NothingCompletes));
    };
    if !experiments.lab.has_budget(Stage::Recalibrate) {
        return Ok(Err(BaselineError::RanOut));
    }
    let mut recalibration = experiments.for_stage(Stage::Recalibrate);
    let errors = input_errors(&mut recalibration, (&first, &first.curves), &inputs.library).await?;
    let wrong: Vec<Curves> = errors.iter().map(|error| error.curves.clone()).collect();
    let groups = ChannelGroup::of(&record, highest, &wrong);
    let mut noise = Noise::estimate(&record, &groups, &wrong);
    let weigh = |noise: &Noise| {
        let mut metric = Metric::new(&groups, noise);
        let directions: Vec<DVector<f64>> = errors
            .iter()
            .map(|error| metric.whiten(&error.curves) * error.deviation)
            .collect();
        metric.marginalize(&directions);
        WhitenedRecord::new(record.clone(), metric, inputs.usual.clone())
    };
    let on = weigh(&noise);
    let mut experiments = experiments.for_record(&on);
    let mut recalibration = experiments.for_stage(Stage::Recalibrate);
    let Some(second) = recalibrate::converge(&mut recalibration, first.point()).await? else {
        return Ok(Err(BaselineError::NothingCompletes));
    };
    let mut finer = experiments.for_stage(Stage::Preflight);
    let preflight = if finer.lab.has_budget(Stage::Preflight) {
        discretisation_check::check(&mut finer, &second, &second, &inputs.finer).await?
    } else {
        None
    };
    let mut notes = Vec::new();
    let (on, fit) = if let Some(seen) = &preflight {
        if !seen.whole {
            notes.push(
                "the finer model did not complete as a whole: its parts were refined one at a time"
                    .to_owned(),
            );
        }
        noise.add_error(&groups, &seen.left);
        let on = weigh(&noise);
        let mut last = Experiments {
            lab: &mut *lab,
            on: &on,
            stage: Stage::Recalibrate,
        };
        match recalibrate::converge_for_tests(&mut last, second.point()).await? {
            Some(fit) => (on, fit),
            None => return Ok(Err(BaselineError::NothingCompletes)),
        }
    } else {
        notes.push("no finer model completed: the numerical error is unknown".to_owned());
        (on, second)
    };
    notes.extend(model_errors(&record));
    let mut finally = Experiments {
        lab,
        on: &on,
        stage: Stage::Recalibrate,
    };
    let (fit, instruments) = constrain_instruments(&mut finally, fit).await?;
    Ok(Ok(Baseline {
        record: on,
        fit,
        preflight,
        instruments,
        notes,
    }))
}

/// Describes in words the standard deviations of the model error that the channels state.
fn model_errors(record: &Record) -> Option<String> {
    let errors = record.channels.iter().filter_map(|own| {
        let error = own.model_error?;
        Some(format!(
            "{} {error} {}",
            own.channel.title, own.channel.unit
        ))
    });
    let errors: Vec<String> = errors.collect();
    (!errors.is_empty()).then(|| {
        format!(
            "stated model errors (`model_error`), which are added to the noise: {}",
            errors.join(", ")
        )
    })
}

/// Dispersion above which a first fit may lie outside the narrow minimum. A complete model leaves less, and
/// the search for the minimum costs little compared with tests at a wrong point.
const DOUBTFUL: f64 = 1.3;

/// Returns a fit under the record's own noise alone, in the narrow minimum of the model without effects as
/// far as it has one.
async fn first_fit<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    inputs: &Inputs,
) -> Result<Option<Fit>, L::Error> {
    let model = FittedModel {
        off: InactiveUnknowns::of(&inputs.unknowns),
        nuisances: NuisanceParameter::all(&experiments.on.record.stated.nuisances, &inputs.library),
        ..FittedModel::plain(inputs.space.clone())
    };
    let nuisances = vec![0.0; model.active_nuisances().count()];
    let starts = if let Some(x) = &inputs.start {
        let point = |x: &Vec<f64>| Point {
            model: model.clone(),
            x: [&x[..], &nuisances].concat(),
        };
        let all = std::iter::once(x).chain(inputs.families.iter().flatten());
        all.map(point).collect()
    } else {
        let search = (inputs.global_search, inputs.seed);
        global_start::global_starts(experiments, &model, &nuisances, search).await?
    };
    let mut recalibration = experiments.for_stage(Stage::Recalibrate);
    let Some(first) = recalibrate::from_starts(&mut recalibration, starts).await? else {
        return Ok(None);
    };
    if first.misfit() > DOUBTFUL
        && inputs.families.is_none()
        && experiments.lab.has_budget(Stage::Basin)
        && let Some(other) = narrow_minimum::scan(experiments, &first).await?
    {
        return Ok(Some(other));
    }
    Ok(Some(first))
}

/// Refits with the instruments constrained to their tolerance if one of them is far beyond it, so that they
/// do not absorb missing effects. Returns the fit and descriptions of those instruments.
async fn constrain_instruments<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: Fit,
) -> Result<(Fit, Vec<String>), L::Error> {
    let beyond = fit.model.indexed_nuisances().filter_map(|(place, one)| {
        let x = fit.x()[place];
        let own = &one.nuisance;
        (x.abs() > BEYOND).then(|| {
            format!(
                "{}.{} {:.1} times its tolerance of {}",
                own.id,
                own.parameter,
                x.abs(),
                own.tolerance()
            )
        })
    });
    let beyond: Vec<String> = beyond.collect();
    if beyond.is_empty() {
        return Ok((fit, beyond));
    }
    let held = fit.point().with_held_instruments();
    let held = recalibrate::converge_for_tests(experiments, held).await?;
    Ok((held.unwrap_or(fit), beyond))
}
