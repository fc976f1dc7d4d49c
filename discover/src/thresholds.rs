//! Every constant that decides something, in one place, with its reason.

use crate::interval::Interval;

/// Standard deviation of a sensor's gain before it is estimated: a calibrated sensor.
pub const GAIN_PRIOR: f64 = 0.01;

/// Standard deviation of a sensor's bias, in standard deviations of its noise.
pub const BIAS_PRIOR: f64 = 10.0;

/// Standard deviation of a sensor's delay, in samples: held somewhere between two of them.
pub const DELAY_PRIOR: f64 = 0.5;

/// Standard deviation of a window's initial state around where the window before ended, in
/// ranges of the state's own motion: next to nothing is known, yet a state that the window
/// does not show stays where it may be.
pub const INITIAL_STATE_PRIOR: f64 = 0.02;

/// Range of a state that nothing moves: a change that moves the outputs by this part of the noise,
/// which no record shows.
pub const UNMOVED_STATE: f64 = 1e-3;

/// If a motion cannot be followed through a record, ranges come from its first half, quarter and so on:
/// the number of halvings.
pub const MOST_HALVINGS: u32 = 6;

/// So many times less is known of the initial state of a coordinate that a candidate adds: what
/// it does goes with the candidate's parameter, which is not known yet.
pub const ADDED_STATE: f64 = 10.0;

/// A shape, such as the speed at which friction has fallen or the deflection at which a stop is met, is
/// searched within these factors of its usual size, for friction a tenth of the usual speed. What has not fallen at a third of that speed
/// is no friction near rest: it would take over what another friction does at every speed.
pub const SHAPE_RANGE: Interval = Interval::new(0.02, 3.0);

/// Columns that agree to this part of their square are one: products of doubles know no
/// better.
pub const RIDGE: f64 = 1e-11;

/// An effect is accepted if the gap on held-out records falls by this part: less matters to
/// nobody, and luck reaches it.
pub const HELD_OUT: f64 = 0.05;

/// And if that fall is this many standard errors over blocks of time.
pub const STANDARD_ERRORS: f64 = 2.0;

/// And if half the fall of the whitened squares is this large: some hundred candidates are
/// screened, of which the luckiest reaches ln 100 = 5.
pub const INFORMATION: f64 = 10.0;

/// And if its parameters are this many standard deviations, correlated residuals allowed for.
pub const SIGNIFICANCE: f64 = 5.0;

/// And if what it does to the channel that shows it best, and nothing else can do, is this many
/// standard deviations of the noise: what is smaller may be anything that repeats by chance.
pub const SIZE: f64 = 1.0;

/// Nothing is left to be found where the gap is within this factor of the floor.
pub const AT_FLOOR: f64 = 1.1;

/// Candidates whose responses agree by more than this are both fitted.
pub const INDISTINGUISHABLE: f64 = 0.95;

/// And they are one class if the held-out gaps that they leave differ by less than
/// `STANDARD_ERRORS`, or by less than this part, and the training gaps by less than this part or
/// `INFORMATION`: what is so small may come from how they were fitted.
pub const DISTINGUISHED: f64 = 0.01;

/// Candidates whose responses agree by more than this are two names of one thing: they are one
/// class unless what they leave differs by `HELD_OUT`, because windows with impacts may end in
/// different folds.
pub const SAME: f64 = 1.0 - 1e-6;

/// A response of which less than this part is its own is indistinguishable from the nuisances,
/// unless that part explains `ENOUGH`.
pub const UNEXPLAINED_FRACTION: f64 = 0.01;

/// The most effects that are added.
pub const MOST_EFFECTS: usize = 4;

/// The most candidates that are fitted in full in one round.
pub const MOST_FITS: usize = 4;

/// A further excitation window is searched, unless what is accepted leaves less than so many
/// floors: what one excitation window shows may stand in for what another shows better.
pub const CLOSE: f64 = 1.5;

/// Or less than this part of the residuals that were there: it is most of the answer, and what is
/// still to come shows better once it is in.
pub const MOST_OF: f64 = 0.3;

/// A candidate is fitted if screening promises that it takes this part of the squares away: a
/// fifth of what a fall of the held-out gap by `HELD_OUT` comes to, because a straight line
/// promises less of what saturates, such as damping.
pub const PROMISE: f64 = 0.02;

/// Where much more than noise is left, effects are far from small and a straight line promises
/// a part of what they do: this part is enough there.
pub const PROMISE_FAR: f64 = 0.005;

/// Much more than noise are so many standard deviations.
pub const MUCH_IS_LEFT: f64 = 3.0;

/// Where more than `CLOSE` floors are left, a candidate whose preliminary fit leaves no less than this part
/// of the squares is not fitted in full: of a hundred such that were, none was accepted.
pub const HELPS: f64 = 0.95;

/// So many candidates are fitted side by side before it is decided whether more are worth it:
/// one per core of a small machine.
pub const FITS_AT_ONCE: usize = 2;

/// A pair is fitted if screening promises that it leaves this part of the squares that the best
/// single one does.
pub const PAIR_PROMISE: f64 = 0.8;

/// Two effects cancel if what either does is this many times what both do together: with less noise
/// neither would be there.
pub const CANCELS: f64 = 3.0;

/// Effects that repeat with an angle, a dozen for every angle, are screened only where no
/// other promises this part of the gap. What promises so much is fitted, however little of it is
/// its own.
pub const ENOUGH: f64 = 0.5;

/// The most candidates, or pairs of them, that are fitted to the beginnings of the windows in
/// one round.
pub const MOST_PRELIMINARY_FITS: usize = 8;

/// Candidates are fitted in full only if, fitted to the beginnings of the windows, they
/// leave less than this times the squares of the best one.
pub const RIVAL: f64 = 1.5;

/// A term of the model may be deleted if its parameter is this many standard deviations of its
/// prior from 0 at most.
pub const PRIOR_REACH: f64 = 3.0;

/// The null model keeps declared parameters and sensors within so many standard deviations of
/// their priors. Beyond, with `STANDARD_ERRORS` of the estimate to spare, it is an effect: one in
/// four hundred is by chance.
pub const SHIFTED: f64 = 3.0;

/// How much wider uncertainties of effects are than a straight line at the estimate makes them: rounding
/// by encoders that goes with the signal, initial states that hold each other, and the bends of the
/// model are not in it. Of some forty estimates of effects made for this, two in three were
/// within 1.645 of the narrower ones.
pub const WIDER: f64 = 1.8;

/// What of a misfit that a right model would not leave looks like what an effect does, so that
/// the effect's size is off by it: chosen on one seed of the blind suite, with 62 sizes.
pub const MISFIT_ALIKE: f64 = 0.3;

/// A residual force is spoken of if it explains this part of the squares: less is seen in every
/// record once windows are fitted.
pub const STANDS_OUT: f64 = 0.1;

/// A residual force is said to be a function of its rate or position if that explains this part of
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

/// It is accepted only if it closes this part of the gap to the floor, on both: what is missing
/// and is a function of rates, positions and inputs can be closed, what is none cannot.
pub const UNNAMED_CLOSES: f64 = 0.5;

/// The most terms that it has: more are read by nobody.
pub const UNNAMED_TERMS: usize = 3;

/// A term more must take this part of the squares that are left without it.
pub const TERM_TAKES: f64 = 0.25;

/// The most equations of motion in which an expression is sought, of those in which a force
/// explains nearly as much: what hangs together stiffly is indistinguishable anyway.
pub const UNNAMED_EQUATIONS: usize = 3;

// Models and their records.

/// What a late sensor shows is interpolated to this part of the noise: less is not seen.
pub const INTERPOLATED: f64 = 0.25;

/// Quantities are computed at most so many times from sample to sample: what would need more
/// is hardly sampled.
pub const MOST_BETWEEN: usize = 4;

/// The cut-off of the zero-phase smoothing, in parts of the sampling frequency. A record is sampled
/// for what it is to show; what moves faster than a fiftieth of that is noise or quantisation to an
/// initial value.
pub const SMOOTHING_CUT_OFF: f64 = 0.02;

/// Samples from which the first value and the first slope of a column are read: a dozen average the
/// noise, and a parabola still follows the motion over so few.
pub const FIRST_SAMPLES: usize = 12;

/// Samples at the beginning of a record over which columns are compared with the model as it is:
/// later what the model lacks has led it away.
pub const CHECKED_SAMPLES: usize = 1000;

/// A channel that moves by fewer standard deviations of its noise, a straight line taken out, shows
/// nothing.
pub const CHECKED_MOTION: f64 = 20.0;

/// Columns whose correlation is above this are one quantity.
pub const FOLLOWS: f64 = 0.98;

/// A channel whose correlation with the model is below this does not follow it: what a model lacks
/// leaves most of the motion.
pub const ASTRAY: f64 = 0.5;

/// A factor between columns is a given one if it agrees to this part of it: a hundredth for what
/// parameters may be off, and as much again for what is lacking.
pub const AGREES: f64 = 0.02;

/// A factor between a column and the model is one, or minus one, to this: what the model lacks may
/// change its size so far.
pub const NEAR_ONE: f64 = 0.2;

/// Switches per simulated second beyond which a trial motion is given up, 1/s: ten times as many as
/// the stiffest contact of the shipped machines makes.
pub const FASTEST_SWITCHING: f64 = 1e5;

/// In so many parts of one step from sample to sample a motion is followed at most: what is faster, such as a
/// drive that is late by a thousandth of a sample, is given up, because nothing shows it and each part takes its time.
pub const MOST_PARTS: f64 = 4096.0;

/// Samples on which the number of steps from sample to sample is tried: some periods of what a record
/// is sampled for.
pub const STEP_TEST_SAMPLES: usize = 100;

/// Steps from sample to sample are tried up to two to this power; what needs more is left to a solver
/// with error control.
pub const MOST_STEP_DOUBLINGS: u32 = 7;

/// The root mean square error of steps of one length, in standard deviations of the noise, with which
/// a simulation is compared.
pub const STEP_ERROR: f64 = 0.2;

/// The root of the sum of squares, over all numbers of the records, of the error of Runge-Kutta steps, in
/// standard deviations of the noise: it moves no estimate by more than this part of its standard
/// deviation.
pub const SUMMED_STEP_ERROR: f64 = 0.1;

/// Relative error of one step of the solver with error control: far below any sensor's noise.
pub const SOLVER_TOLERANCE: f64 = 1e-7;

/// The most steps of that solver in one window: some seconds.
pub const MOST_SOLVER_STEPS: u64 = 400_000;

// Fits.

/// The parts of a window over which initial states are fitted, one after the other: a short motion
/// is nearly linear in its initial state. Chosen on the development seeds of the blind suite.
pub const HORIZONS: [f64; 4] = [0.08, 0.25, 0.5, 1.0];

/// Others, for another try: where impacts fold the outputs, one sequence may end in the wrong fold
/// and another in the right one.
pub const OTHER_HORIZONS: [f64; 5] = [0.05, 0.12, 0.3, 0.7, 1.0];

/// Parts of a record that are followed side by side from another estimate's initial states: one per
/// core of a small machine, and not more on a larger one, so that results do not depend on the
/// machine.
pub const CHAINS: usize = 2;

/// A step of the continuation that lowers the cost by less than this part is the last: each follows
/// all windows anew.
pub const CONTINUATION_DECREASE: f64 = 0.02;

/// The most steps by secants, where tangents lead nowhere. Chosen on the development seeds of the
/// blind suite.
pub const SECANT_STEPS: usize = 6;

/// A secant changes an unknown by this part of its scale at first.
pub const FIRST_SECANT: f64 = 0.1;

/// Then by what moves the outputs by this part of the residuals: far above the small folds of
/// impacts, and no farther than the estimate is off.
pub const SECANT_MOVES: f64 = 0.3;

/// Within this factor a secant is as large as wanted.
pub const SECANT_NEAR: f64 = 3.0;

/// A Gauss-Newton step that lowers the cost by less than this part is the last: what is gained is
/// far below what a threshold asks of an effect.
pub const LEAST_DECREASE: f64 = 1e-3;

/// Parts of a step of the unknowns that are tried, one after the other.
pub const STEP_PARTS: [f64; 3] = [1.0, 0.3, 0.05];

/// Damping of a step of the unknowns where no part of it helps, in norms of its columns.
pub const STEP_DAMPING: [f64; 4] = [0.0, 0.03, 1.0, 30.0];

/// Damping of an initial state's step, in weights of its prior: where a state's impacts fold the
/// outputs, only shorter steps along what is well determined help.
pub const INITIAL_STATE_DAMPING: [f64; 5] = [0.0, 1e2, 1e4, 1e6, 1e9];

/// The most steps of an initial state over one part of a window.
pub const INNER_STEPS: usize = 6;

/// The most Gauss-Newton steps over whole windows between two followings of them. Chosen on the
/// development seeds of the blind suite.
pub const FULL_STEPS: usize = 4;

/// The most further steps over beginnings of windows before whole ones are fitted.
pub const FURTHER_STEPS: usize = 12;

/// What leaves more standard deviations than this over whole windows is not worth following anew, and what
/// leaves so many times what a fit leaves is no place to begin beside it.
pub const HOPELESS: f64 = 8.0;

/// What begins where a fit ended, and leaves so many times what that leaves of the training records after the
/// first steps, is judged as it stands.
pub const FAR: f64 = 3.0;

/// Windows are followed anew so often at most.
pub const REFRESHES: usize = 2;

/// And only while that lowers the cost by this part.
pub const REFRESH_DECREASE: f64 = 0.005;

/// The most windows over which candidates are linearised, spread evenly over the records: screening
/// a hundred candidates costs less than one full fit then.
pub const MOST_WINDOWS: usize = 40;

/// Windows that are enough to compare a few equations of motion.
pub const FEW_WINDOWS: usize = 20;

/// Blocks of time into which a set of windows is parted to judge what differs by chance: enough for
/// a standard error, and each longer than residuals are correlated.
pub const BLOCKS: usize = 40;

/// The most steps of the continuation while unknowns are far away.
pub const CONTINUATION_STEPS: usize = 5;

/// Steps of a preliminary fit where initial states are read from the record.
pub const PRELIMINARY_STEPS: usize = 3;

/// A difference quotient moves the outputs by this part of what the residual is: far above
/// rounding, and over the small folds that impacts leave in the outputs.
pub const QUOTIENT: f64 = 0.3;

/// A difference quotient is not taken over more than this part of a state's own range.
pub const LARGEST_QUOTIENT: f64 = 0.03;

/// The part of each window, from its beginning, to which preliminary fits are made: a motion is
/// nearly linear there in whatever changes it. Chosen on the development seeds of the blind suite.
pub const FIRST_PART: f64 = 0.25;

/// So many of `HORIZONS` lead up to it.
pub const FIRST_HORIZONS: usize = 2;

/// A step of an initial state that lowers its window's cost by less than this part is the last.
pub const INNER_DECREASE: f64 = 1e-2;

/// An autocorrelation below this is none: white noise of a few hundred samples shows as much by
/// chance.
pub const CORRELATED: f64 = 0.05;

/// A time between samples may be longer than a step by this part of it: samples come late or early.
pub const JITTER: f64 = 0.1;

/// A parameter's difference quotient is taken over this part of its scale.
pub const PARAMETER_QUOTIENT: f64 = 0.01;

/// Neighbouring motions that come along with an integrated one are off by this part at most, but for
/// impacts.
pub const TANGENT_ERROR: f64 = 0.1;

/// A central difference is taken over this part of a parameter's scale or a state's range: far above
/// rounding, and its error falls with the square.
pub const CENTRAL_QUOTIENT: f64 = 0.001;

/// The most of the last Gauss-Newton steps of a fit: a valley along what the records hardly show is
/// curved, and the better it is seen, the shorter they are.
pub const LAST_STEPS: usize = 12;

/// The most corrections of the initial states after a step of the unknowns; each removes most of the error
/// that is left.
pub const CORRECTIONS: usize = 4;

/// The last steps of a fit go on while they lower the cost by this part of what one standard deviation
/// is worth.
pub const LEAST_INFORMATION: f64 = 0.01;

/// A sensor's, whose outputs are linear in it, over this part.
pub const SENSOR_QUOTIENT: f64 = 0.1;

// The catalogue.

/// The largest file of a user's effects that is read, in bytes: a thousand effects.
pub const LARGEST_EFFECTS_FILE: u64 = 1 << 20;

/// Shaft orders, per turn, at which effects that repeat with an angle are tried, beside numbers of
/// teeth: those of unbalance, joints, small pinions and the poles of motors.
pub const SHAFT_ORDERS: [u32; 8] = [1, 2, 3, 4, 6, 8, 12, 24];

/// The highest order of which a wave is sought in the residual force over an angle: more than twice the
/// poles of the usual motors.
pub const HIGHEST_ORDER: u32 = 48;

/// So many orders of that spectrum, per angle, are candidates beside the usual ones.
pub const MOST_ORDERS: usize = 4;

// Screening.

/// A candidate is linearised at a size that changes accelerations by this part of their own size,
/// in any direction: small beside them, large beside rounding.
pub const SMALL_CHANGE: f64 = 1e-4;

/// A change is small and above rounding if these factors bring it there.
pub const SMALL_NEAR: Interval = Interval::new(0.1, 1e3);

/// A search for a size that starts at one SI unit ends if the next size would differ by less than this
/// factor, so that results do not depend on units.
pub const SAME_SIZE: Interval = Interval::new(1.0 - 1e-9, 1.0 + 1e-9);

/// Every so many samples of a window such a size is looked for.
pub const SAMPLED: usize = 5;

/// A candidate's response by simulation is taken at the size that moves the outputs by this part of
/// the residuals.
pub const RESPONSE_MOVES: f64 = 0.3;

/// Parts of the size that screening promises among which a fit begins with the best: a straight
/// line leads far beyond where impacts fold the outputs, and not far enough where an effect that
/// grows does less and less.
pub const INITIAL_PARTS: [f64; 5] = [1.0, 0.3, 0.1, 3.0, 10.0];

/// How many times its usual size a shape is where a fit is started anew from another: as far from it
/// to either side.
pub const OTHER_SHAPES: [f64; 2] = [0.4, 2.5];

/// Corrections of a size that started at a typical one once it is near the wanted one. Each costs a motion.
pub const SIZE_CORRECTIONS: usize = 2;

/// Attempts to find the size at which a candidate is linearised or simulated.
pub const SIZE_ATTEMPTS: usize = 8;

/// Each attempt changes the size by this factor at most.
pub const SIZE_FACTOR: f64 = 1e6;

/// Within these factors of `RESPONSE_MOVES` a response is as large as wanted.
pub const RESPONSE_NEAR: Interval = Interval::new(0.2, 5.0);

// The residual force.

/// Shaft orders, per turn, over which a residual force is shown.
pub const FORCE_ORDERS: [u32; 10] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 36];

/// The most frequencies over which a residual force is shown: a picture shows no more.
pub const MOST_FREQUENCIES: usize = 12;

/// Bends of a force over a whole turn.
pub const TURN_BENDS: usize = 12;

/// Between both sides of a turning point lies this part of the largest rate.
pub const TURNING: f64 = 1e-3;

/// A force is taken that moves the outputs by this part of the residuals.
pub const FORCE_MOVES: f64 = 0.3;

/// A first one changes accelerations by this part of their own.
pub const FIRST_FORCE: f64 = 1e-4;

/// It need not be nearer to what is wanted than by this factor.
pub const FORCE_NEAR: f64 = 10.0;

/// Factor by which a force is reduced if its motion leaves the domain of the model.
pub const FORCE_SHRINKS: f64 = 1e3;

/// Rounds in which the usual size of a force that differs from window to window is found: it
/// changes by less than a part in a hundred by then.
pub const VARIANCE_ROUNDS: usize = 12;

/// A point of a profile is drawn if its standard deviation is below this part of the largest force.
pub const DRAWN: f64 = 0.5;

/// And a profile if so many of its points are.
pub const DRAWN_POINTS: usize = 2;

/// Bends of a force over the rate, on either side of rest.
pub const RATE_BENDS: usize = 5;

/// Bends of a force over the position.
pub const POSITION_BENDS: usize = 9;

/// Bends of a force over the time of a window.
pub const TIME_BENDS: usize = 8;

/// So many of the frequencies are the lowest whole numbers of periods per window.
pub const FIRST_FREQUENCIES: usize = 4;

/// Higher ones follow by this ratio.
pub const FREQUENCY_RATIO: f64 = 1.6;

/// A period lasts so many samples at least: less is not resolved.
pub const PERIOD_SAMPLES: f64 = 4.0;

// Expressions without a name.

/// The highest degree of a product: with more, expressions differ in little but their ends.
pub const MOST_DEGREE: u32 = 3;

/// Where a force over a position may begin to act, on either side, in parts of the largest position; where it does
/// is fitted.
pub const KINKS: [f64; 4] = [0.2, 0.4, 0.6, 0.8];

/// A step over the rate is made within this part of the largest rate: as steep as friction near
/// rest is seldom seen to be otherwise, and no jump, so that it can be multiplied.
pub const STEEP: f64 = 0.03;

// The report.

/// What leaves more floors than this, in any channel, may be something else than what it is called: it
/// is provisional. A bump stop that came out as friction and a spring left 41.
pub const MAY_STAND_IN: f64 = 3.0;

/// The most a right model leaves, in floors of a channel: noise is drawn anew in each record.
pub const ONE_FLOOR: f64 = 1.5;

/// A nuisance from this part of `SHIFTED` on stands at its bound: an estimate ends within rounding
/// of it.
pub const AT_BOUND: f64 = 0.99;

/// Channels are late alike if the least of their delays is at least this part of the greatest.
pub const LATE_ALIKE: f64 = 0.9;

/// Where nothing was found, a parameter or a sensor is written back if its estimate moved by this
/// part of its standard deviation. With an effect all are: they were estimated together.
pub const WRITTEN_FROM: f64 = 0.5;

/// A line stands out of a spectrum, averaged over n windows, if it exceeds the mean of the others by this
/// factor over the square root of n: of white noise, one spectrum in some thousand holds such a line.
pub const SPECTRAL_PEAK: f64 = 10.0;

/// First line of a window's spectrum that is a frequency: fewer periods cannot be told from a drift, whose
/// straight line is removed and which the taper spreads.
pub const FIRST_LINE: usize = 3;

/// A ratio between the residuals of slow and of fast motion below this is not worth a word.
pub const WORTH_SAYING: f64 = 1.5;

/// Records contradict each other only where each alone leaves less than the fit of all by this
/// factor: what is missing in a model bends its parameters a little in every record.
pub const CONTRADICTS: f64 = 2.0;

/// And where their values differ by this part: less is what one machine does on two days.
pub const CONTRADICTING_PART: f64 = 0.1;

// The next experiment.

/// What is played separates two members if it leaves the wrong one this many standard deviations of the
/// noise in the channel that shows it best: then it leaves three floors, and nobody takes it for right.
pub const SEPARATES: f64 = 3.0;

/// The most samples of an experiment of which nobody said how long it lasts: a hundred of it are simulated.
pub const EXPERIMENT_SAMPLES: f64 = 4000.0;

/// The most steps that a solver with error control may take from sample to sample of an experiment, and the most
/// surfaces that a motion may cross there, on average: of a hundred inputs those that take more, as where a load
/// holds a machine by friction, are not worth minutes. Teeth that rattle cross a few.
pub const EXPERIMENT_STEPS: usize = 20;

/// Sizes of an input that are tried, in parts of its range: what moves far leaves its limits at the
/// larger ones.
pub const EXPERIMENT_SIZES: [f64; 6] = [1.0, 0.5, 0.25, 0.1, 0.05, 0.02];

/// A rate of a spring or a damper of more terms, written out, is compared with nothing: those of machines
/// have a handful, and what is multiplied out has more and more.
pub const MOST_TERMS_OF_A_RATE: usize = 64;

/// And so is one that holds a higher power.
pub const HIGHEST_POWER_OF_A_RATE: u8 = 8;

/// The band of a recorded input is where this part of its power is.
pub const RECORDED_POWER: f64 = 0.99;

/// How far beyond what was recorded a channel may go, in parts of that: records of one motion differ by
/// so much.
pub const LIMIT_MARGIN: f64 = 0.05;

/// So many of the inputs that promise most by a straight line are tried with rivals fitted anew.
pub const EXPERIMENTS_REFITTED: usize = 3;

/// What an experiment shows of something small: [`SEPARATES`], but for what a straight line is off by.
pub const SHOWS: f64 = 2.0;

/// What could not be tested is looked at once for each effect and place, so many in all: what would show
/// one often shows the next.
pub const MOST_SHOWN: usize = 3;

/// How far something moves the outputs where it is taken to be small, in standard deviations of the
/// noise: a straight line holds there.
pub const SHOWN_BY: f64 = 3.0;

/// And how near that its size is chosen.
pub const SHOWN_WITHIN: Interval = Interval::new(1.0, 10.0);

/// The most steps of such a fit: far from where records left it a rival that has not come as near as it
/// can would seem to be told.
pub const REFIT_STEPS: usize = 30;

/// And parts of a step, until it helps.
pub const REFIT_PARTS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];

/// Steps of Newton's method to the inputs that a given motion takes: one where second rates are linear in
/// them, a few more where a drive saturates.
pub const REQUIRED_STEPS: usize = 12;

/// A difference quotient by such an input is taken over the noise of its sensor, and over no less than
/// this part of the input.
pub const REQUIRED_QUOTIENT: f64 = 1e-6;

/// By how much second rates may be off at these inputs, in parts of themselves: far more than rounding
/// makes of a regular system, far less than any sensor shows.
pub const REQUIRED_ERROR: f64 = 1e-9;
