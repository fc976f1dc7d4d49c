//! Every constant that decides something, in one place, with its reason.

/// Standard deviation of a sensor's gain before it is estimated: a calibrated sensor.
pub const GAIN_PRIOR: f64 = 0.01;

/// Standard deviation of a sensor's bias, in noises.
pub const BIAS_PRIOR: f64 = 10.0;

/// Standard deviation of a sensor's delay, in samples: held somewhere between two of them.
pub const DELAY_PRIOR: f64 = 0.5;

/// Standard deviation of a window's initial state around where the window before ended, in
/// ranges of the state's own motion: next to nothing is known, yet a state that the window
/// does not show stays where it may be.
pub const START_PRIOR: f64 = 0.02;

/// So many times less is known of the initial state of a coordinate that a candidate adds: what
/// it does goes with the candidate's parameter, which is not known yet.
pub const ADDED_STATE: f64 = 10.0;

/// A shape, such as the speed at which friction has fallen, is searched within these factors
/// of its usual size, a tenth of the usual speed. What has not fallen at a third of that speed
/// is no friction near rest: it would take over what another friction does at every speed.
pub const SHAPE_RANGE: (f64, f64) = (0.02, 3.0);

/// Columns that agree to this part of their square are one: products of doubles know no
/// better.
pub const RIDGE: f64 = 1e-11;

/// An effect is believed if the gap on held-out records falls by this part: less matters to
/// nobody, and luck reaches it.
pub const HELD_OUT: f64 = 0.05;

/// And if that fall is this many standard errors over blocks of time.
pub const STANDARD_ERRORS: f64 = 2.0;

/// And if half the fall of the whitened squares is this large: some hundred candidates are
/// looked at, of which the luckiest reaches ln 100 = 5.
pub const INFORMATION: f64 = 10.0;

/// And if its parameters are this many standard deviations, correlated residuals allowed for.
pub const SIGNIFICANCE: f64 = 5.0;

/// And if what it does to the channel that shows it best, and nothing else can do, is this many
/// noises: what is smaller may be anything that repeats by chance.
pub const SIZE: f64 = 1.0;

/// Nothing is left to be found where the gap is within this factor of the floor.
pub const AT_FLOOR: f64 = 1.1;

/// Candidates whose responses agree by more than this are both fitted.
pub const ALIKE: f64 = 0.95;

/// And they are one class if the held-out gaps that they leave differ by less than
/// `STANDARD_ERRORS`, or by less than this part, and the training gaps by less than this part or
/// `INFORMATION`: what is so small may come from how they were fitted.
pub const TOLD_APART: f64 = 0.01;

/// Candidates whose responses agree by more than this are two names of one thing: they are one
/// class unless what they leave differs by `HELD_OUT`, because windows with impacts may end in
/// different folds.
pub const SAME: f64 = 1.0 - 1e-6;

/// A response of which less than this part is its own cannot be told from the nuisances, unless
/// that part explains `ENOUGH`.
pub const OWN_PART: f64 = 0.01;

/// The most effects that are added.
pub const MOST_EFFECTS: usize = 4;

/// The most candidates that are fitted in earnest in one round.
pub const MOST_FITS: usize = 4;

/// Motions are looked at in another way too, unless what is believed leaves less than so many
/// floors: what one view shows may stand in for what another shows better.
pub const CLOSE: f64 = 1.5;

/// Or less than this part of the noises that were left: it is most of the answer, and what is
/// still to come shows better once it is in.
pub const MOST_OF: f64 = 0.3;

/// A candidate is fitted if screening promises that it takes this part of the squares away: a
/// fifth of what a fall of the held-out gap by `HELD_OUT` comes to, because a straight line
/// promises less of what saturates, such as damping.
pub const PROMISE: f64 = 0.02;

/// Where much more than noise is left, effects are far from small and a straight line promises
/// a part of what they do: this part is enough there.
pub const PROMISE_FAR: f64 = 0.005;

/// Much more than noise are so many noises.
pub const FAR: f64 = 3.0;

/// Where more than `CLOSE` floors are left, a candidate that, begun, leaves no less than this part
/// of the squares is not fitted in earnest: of a hundred such that were, none was believed.
pub const HELPS: f64 = 0.95;

/// So many candidates are fitted side by side before it is decided whether more are worth it:
/// one per core of a small machine.
pub const FITS_AT_ONCE: usize = 2;

/// A pair is fitted if screening promises that it leaves this part of the squares that the best
/// single one does.
pub const PAIR_PROMISE: f64 = 0.8;

/// Effects that repeat with an angle, a dozen for every angle, are screened only where no
/// other promises this part of the gap. What promises so much is fitted, however little of it is
/// its own.
pub const ENOUGH: f64 = 0.5;

/// The most candidates, or pairs of them, that are fitted to the beginnings of the windows in
/// one round.
pub const MOST_SKETCHES: usize = 8;

/// Candidates are fitted in earnest only if, fitted to the beginnings of the windows, they
/// leave less than this times the squares of the best one.
pub const RIVAL: f64 = 1.5;

/// A term of the model may be deleted if its parameter is this many standard deviations of its
/// prior from 0 at most.
pub const PRIOR_REACH: f64 = 3.0;

/// The null model keeps declared parameters and sensors within so many standard deviations of
/// their priors. Beyond, with `STANDARD_ERRORS` of the estimate to spare, it is an effect: one in
/// four hundred is by chance.
pub const SHIFTED: f64 = 3.0;

/// How much wider uncertainties are than a straight line at the estimate makes them: rounding by
/// encoders that goes with the signal, initial states that hold each other, and the bends of the
/// model are not in it. Of some forty estimates of effects made for this, two in three were
/// within 1.645 of the narrower ones.
pub const WIDER: f64 = 1.8;

/// A residual force is spoken of if it explains this part of the squares: less is seen in every
/// record once windows are fitted.
pub const STANDS_OUT: f64 = 0.1;

/// A residual force is said to be a function of its rate or place if that explains this part of
/// what a force that is free in every window does.
pub const STATE_EXPLAINS: f64 = 0.6;

/// It is described by a simple function, or two, if these explain this part of what a line with
/// many bends does.
pub const IS_SIMPLE: f64 = 0.9;

/// A force in another equation explains nearly as much if it explains this part.
pub const AS_WELL: f64 = 0.9;

/// A straight line at a motion that is off is right to about this part of the force that is
/// sought: springs and friction that were hidden on purpose came out 1 to 5 % off.
pub const STRAIGHT: f64 = 0.05;

/// An expression that has no name is sought only where so many floors are left, on training and
/// on test records: less may be what fits of what has a name did not reach.
pub const UNNAMED_FROM: f64 = 2.0;

/// It is believed only if it closes this part of the gap to the floor, on both: what is missing
/// and is a function of rates, places and inputs can be closed, what is none cannot.
pub const UNNAMED_CLOSES: f64 = 0.5;

/// The most terms that it has: more are read by nobody.
pub const UNNAMED_TERMS: usize = 3;

/// A term more must take this part of the squares that are left without it.
pub const TERM_TAKES: f64 = 0.25;

/// The most equations of motion in which an expression is sought, of those in which a force
/// explains nearly as much: what hangs together stiffly cannot be told apart anyway.
pub const UNNAMED_EQUATIONS: usize = 3;
