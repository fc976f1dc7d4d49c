//! Search: judges all claims for thousands of parameter sets, then the best sets again with longer runs, and the
//! neighbourhood of the best set.
//!
//! Sets are judged in parallel, in chunks. The file of a complete chunk is written under a temporary name and renamed.
//! A search that is interrupted and resumed gives a bit-identical result.

use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::arm::{Arm, ArmShapes, UndisclosedParameters};
use super::case::{RunLength, measure};
use super::claims::{CLAIMS, cases};
use super::error::StudyError;
use super::judge::{Judgement, Readings, Verdict, judge};
use super::reading::Reading;
use super::sets::{create_neighbouring_set, create_parameter_set};

/// Version of the rules; results of other versions are rejected.
const RULES_VERSION: u32 = 3;

const SETS_PER_CHUNK: usize = 20;

/// Request for a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SearchRequest {
    /// Number of screened sets.
    pub sets: usize,
    /// Seed of the sequence of sets.
    pub seed: u64,
    /// Number of the best sets that are judged again with longer runs.
    pub confirmed: usize,
    /// Number of judged neighbours of the best set, which differ by up to 10 % in each parameter.
    pub neighbours: usize,
    /// Lengths of the runs for screening.
    pub screening: RunLength,
    /// Lengths of the runs for the best sets.
    pub confirming: RunLength,
}

/// Parameter set with its verdicts, one letter per claim: H, F or U.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedSet {
    /// Index in the sequence.
    pub index: usize,
    /// Values of the undisclosed parameters.
    pub undisclosed: UndisclosedParameters,
    /// Verdicts in the generous reading.
    pub verdicts: Vec<char>,
    /// Verdicts in the strict reading.
    pub strict: Vec<char>,
}

/// Result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchResult {
    /// All sets as screened, in the order of the sequence.
    pub screened: Vec<JudgedSet>,
    /// Best sets judged again, the best first.
    pub confirmed: Vec<JudgedSet>,
    /// Neighbours of the best set.
    pub neighbours: Vec<JudgedSet>,
}

impl JudgedSet {
    /// Returns the number of claims that hold.
    pub fn holding_claims(&self) -> usize {
        self.verdicts
            .iter()
            .filter(|letter| **letter == 'H')
            .count()
    }

    /// Returns the number of claims that hold in the strict reading.
    pub fn strictly_holding(&self) -> usize {
        self.strict.iter().filter(|letter| **letter == 'H').count()
    }

    /// Formats a line: index, values, counts, verdicts, verdicts in the strict reading.
    pub fn to_line(&self) -> String {
        let UndisclosedParameters {
            second_moment,
            a_m,
            b_m,
            f_w,
            c,
        } = self.undisclosed;
        let (letters, strict): (String, String) =
            (self.verdicts.iter().collect(), self.strict.iter().collect());
        format!(
            "{},{second_moment:?},{a_m:?},{b_m:?},{f_w:?},{c:?},{},{},{letters},{strict}",
            self.index,
            self.holding_claims(),
            self.strictly_holding(),
        )
    }

    /// Parses a line of [`JudgedSet::to_line`].
    pub fn parse(line: &str) -> Option<Self> {
        let fields: Vec<&str> = line.split(',').collect();
        let [index, i, a, b, f, c, _, _, letters, strict] = fields[..] else {
            return None;
        };
        let judged = Self {
            index: index.parse().ok()?,
            undisclosed: UndisclosedParameters {
                second_moment: i.parse().ok()?,
                a_m: a.parse().ok()?,
                b_m: b.parse().ok()?,
                f_w: f.parse().ok()?,
                c: c.parse().ok()?,
            },
            verdicts: letters.chars().collect(),
            strict: strict.chars().collect(),
        };
        let whole = judged.verdicts.len() == CLAIMS.len() && judged.strict.len() == CLAIMS.len();
        whole.then_some(judged)
    }
}

/// Returns the truncation orders that the claims need.
pub fn orders() -> Vec<usize> {
    let mut orders: Vec<usize> = cases().iter().map(|key| key.order).collect();
    orders.sort_unstable();
    orders.dedup();
    orders
}

/// Measures all cases in parallel and judges all claims for one parameter set. If a case cannot be measured, its claims
/// are undecided.
pub fn judge_all(
    arm: &Arm,
    undisclosed: UndisclosedParameters,
    length: &RunLength,
) -> (Readings, Vec<Judgement>) {
    let readings = cases().into_par_iter().filter_map(|key| {
        let measured = measure(arm, &key.case(undisclosed), length);
        measured
            .ok()
            .map(|measured| (key, Reading::from_measurement(&measured)))
    });
    let readings: Readings = readings.collect();
    let judgements = CLAIMS.iter().map(|claim| judge(claim, &readings)).collect();
    (readings, judgements)
}

fn judged(
    arm: &Arm,
    index: usize,
    undisclosed: UndisclosedParameters,
    length: &RunLength,
) -> JudgedSet {
    let (_, judgements) = judge_all(arm, undisclosed, length);
    let letters =
        |of: fn(&Judgement) -> Verdict| judgements.iter().map(|j| of(j).letter()).collect();
    JudgedSet {
        index,
        undisclosed,
        verdicts: letters(|judgement| judgement.holding),
        strict: letters(|judgement| judgement.strict),
    }
}

/// Runs a search and stores its results in `folder`. `progress` receives the number of completed sets.
///
/// # Errors
/// A folder that cannot be written, or that contains another search.
pub fn search(
    arm: &Arm,
    request: &SearchRequest,
    folder: &Path,
    progress: &mut dyn FnMut(usize),
) -> Result<SearchResult, StudyError> {
    let store = Store::open(folder, request, arm.shapes())?;
    let sets: Vec<(usize, UndisclosedParameters)> = (0..request.sets)
        .map(|index| (index, create_parameter_set(index, request.seed)))
        .collect();
    let mut run =
        |stage: &str, sets: &[(usize, UndisclosedParameters)], length: &RunLength, done: usize| {
            store.stage(
                stage,
                sets,
                &|set| judged(arm, set.0, set.1, length),
                &mut |count| progress(done + count),
            )
        };
    let screened = run("screened", &sets, &request.screening, 0)?;
    let best: Vec<(usize, UndisclosedParameters)> = rank(&screened)
        .into_iter()
        .take(request.confirmed)
        .map(|judged| (judged.index, judged.undisclosed))
        .collect();
    let again = run("confirmed", &best, &request.confirming, request.sets)?;
    let confirmed: Vec<JudgedSet> = rank(&again).into_iter().cloned().collect();
    let around: Vec<(usize, UndisclosedParameters)> =
        confirmed.first().map_or(Vec::new(), |best| {
            (0..request.neighbours)
                .map(|index| {
                    (
                        index,
                        create_neighbouring_set(&best.undisclosed, index, request.seed),
                    )
                })
                .collect()
        });
    let done = request.sets + best.len();
    let neighbours = run("neighbours", &around, &request.confirming, done)?;
    Ok(SearchResult {
        screened,
        confirmed,
        neighbours,
    })
}

/// Sorts parameter sets by the number of claims that hold, then by the number that hold in the strict reading, then by
/// index.
pub fn rank(judged: &[JudgedSet]) -> Vec<&JudgedSet> {
    let mut ranked: Vec<&JudgedSet> = judged.iter().collect();
    ranked.sort_by_key(|judged| {
        let counts = (judged.holding_claims(), judged.strictly_holding());
        (std::cmp::Reverse(counts), judged.index)
    });
    ranked
}

/// Folder of a search, with one file per complete chunk.
struct Store {
    folder: PathBuf,
}

impl Store {
    fn open(folder: &Path, request: &SearchRequest, shapes: ArmShapes) -> Result<Self, StudyError> {
        let store = Self {
            folder: folder.to_owned(),
        };
        fs::create_dir_all(folder).map_err(|error| file_error("make", folder, &error))?;
        let description = folder.join("request.txt");
        let claims: Vec<&str> = CLAIMS.iter().map(|claim| claim.id).collect();
        let claims = claims.join(" ");
        let text =
            format!("{request:?}\n{shapes:?} mode shapes\n{claims}\nrules {RULES_VERSION}\n");
        match fs::read_to_string(&description) {
            Ok(found) if found == text => {}
            Ok(_) => {
                return Err(StudyError::Request(format!(
                    "{} contains a different search; choose another folder, or remove it",
                    folder.display()
                )));
            }
            Err(_) => store.write(&description, &text)?,
        }
        Ok(store)
    }

    fn stage(
        &self,
        stage: &str,
        sets: &[(usize, UndisclosedParameters)],
        judge: &(dyn Fn(&(usize, UndisclosedParameters)) -> JudgedSet + Sync),
        progress: &mut dyn FnMut(usize),
    ) -> Result<Vec<JudgedSet>, StudyError> {
        let mut all = Vec::with_capacity(sets.len());
        for (number, chunk) in sets.chunks(SETS_PER_CHUNK).enumerate() {
            let path = self.folder.join(format!("{stage}_{number:05}.csv"));
            let judged = match read(&path, chunk.len()) {
                Some(judged) => judged,
                None => {
                    let judged: Vec<JudgedSet> = chunk.par_iter().map(judge).collect();
                    let lines: Vec<String> = judged.iter().map(JudgedSet::to_line).collect();
                    self.write(&path, &(lines.join("\n") + "\n"))?;
                    judged
                }
            };
            all.extend(judged);
            progress(all.len());
        }
        Ok(all)
    }

    /// Writes a file under a temporary name and renames it.
    fn write(&self, path: &Path, text: &str) -> Result<(), StudyError> {
        let unfinished = path.with_extension("unfinished");
        fs::write(&unfinished, text)
            .and_then(|()| fs::rename(&unfinished, path))
            .map_err(|error| file_error("write", path, &error))
    }
}

/// Reads a chunk, or returns `None` if it is missing or incomplete.
fn read(path: &Path, length: usize) -> Option<Vec<JudgedSet>> {
    let text = fs::read_to_string(path).ok()?;
    let judged: Option<Vec<JudgedSet>> = text.lines().map(JudgedSet::parse).collect();
    judged.filter(|judged| judged.len() == length)
}

fn file_error(action: &str, path: &Path, error: &std::io::Error) -> StudyError {
    StudyError::File(format!("cannot {action} {}: {error}", path.display()))
}
