//! Assessment of a machine after a run, such as the life of a part: kept as data, so that the report of the run shows it.
use super::document::{Block, Figure, Report, Section, Table, figures, tables};
use serde::{Deserialize, Serialize};

/// Topic of an assessment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Topic {
    /// Fatigue life of a part.
    Life,
    /// Torque of the drive and its balance.
    Balance,
}

/// Assessment of a machine: what the report of a run, and the page of the assessment itself, say of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MachineAssessment {
    /// Topic of the assessment.
    pub topic: Topic,
    /// Main result in one sentence.
    pub lead: String,
    /// Tables, the most important first.
    pub tables: Vec<Table>,
    /// Notes, one sentence each.
    pub notes: Vec<String>,
    /// Figures in reading order.
    pub figures: Vec<Figure>,
}

impl MachineAssessment {
    /// Builds the section of a report that shows the assessment.
    pub fn section(&self) -> Section {
        let (id, title) = match self.topic {
            Topic::Life => ("life", "Life"),
            Topic::Balance => ("balance", "Balance"),
        };
        let mut blocks = vec![Block::Lead(self.lead.clone())];
        if !self.notes.is_empty() {
            blocks.push(Block::List(self.notes.clone()));
        }
        let mut rest = tables(self.tables.iter().cloned());
        // the first table answers; the figures come before what details it
        let details = rest.split_off(rest.len().min(1));
        blocks.extend(rest);
        blocks.extend(figures(self.figures.iter().cloned()));
        blocks.extend(details);
        Section { id, title, blocks }
    }

    /// Builds the report of the assessment alone.
    pub fn report(&self, title: String, run: &str) -> Report {
        Report::new(title, run, [self.section()])
    }
}
