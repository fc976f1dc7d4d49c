//! Limits and settings of search and estimation, each with its reason.

use crate::interval::Interval;

/// Prior standard deviation of the gain of a sensor: a calibrated sensor.
pub const GAIN_PRIOR_SD: f64 = 0.01;

/// Prior standard deviation of the bias of a sensor, in standard deviations of its noise.
pub const BIAS_PRIOR_IN_NOISE_SD: f64 = 10.0;

/// Prior standard deviation of the delay of a sensor, in samples: the sampling time within an
/// interval is unknown.
pub const DELAY_PRIOR_SAMPLES: f64 = 0.5;

/// Prior standard deviation of the initial state of a window around the final state of the previous
/// window, in ranges of the state. It keeps states that the window does not determine near the
/// prior, and hardly affects the others.
pub const INITIAL_STATE_PRIOR_IN_RANGES: f64 = 0.02;

/// Ratio of two estimates of a state's range above which the larger one is used. It only limits the
/// number of repeated fits of first states.
pub const MAX_RANGE_RATIO: f64 = 2.0;

/// Maximum number of fits of first states that estimate the ranges of the states. The free decay of
/// a drive with an initially twisted shaft needs two.
pub const MAX_RANGE_FITS: usize = 6;

/// Output change that defines the range of a state that nothing excites, as a fraction of the
/// noise.
pub const INVISIBLE_CHANGE_IN_NOISE: f64 = 1e-3;

/// Maximum number of halvings of a record for the estimate of the ranges. A record is halved if its
/// motion diverges.
pub const MAX_RECORD_HALVINGS: u32 = 6;

/// Factor on the prior standard deviation of the initial state of a coordinate that a candidate
/// adds, because the parameters of the candidate are still unknown.
pub const ADDED_STATE_PRIOR_FACTOR: f64 = 10.0;

/// Limits of a shape parameter, relative to its typical size. Examples are the Stribeck speed and
/// the deflection of an end stop. For friction, the typical size is a tenth of the usual speed. A
/// larger Stribeck speed would imitate other friction laws at every speed.
pub const SHAPE_SEARCH_RANGE: Interval = Interval::new(0.02, 10.0);

/// Relative squared difference below which two columns are equal: the limit of double precision.
pub const MIN_COLUMN_REMAINDER: f64 = 1e-11;

/// Minimum relative reduction of the gap on held-out records for an accepted effect. A smaller
/// reduction has no practical value and can be due to chance.
pub const MIN_HELD_OUT_REDUCTION: f64 = 0.05;

/// Minimum of the held-out reduction in standard errors over blocks of time.
pub const MIN_REDUCTION_STANDARD_ERRORS: f64 = 2.0;

/// Minimum of half the reduction of the whitened sum of squares. The best of a hundred candidates
/// without effect reaches ln 100 = 5.
pub const MIN_INFORMATION_GAIN: f64 = 10.0;

/// Minimum size of the parameters of an accepted effect, in standard deviations that include the
/// correlation of residuals.
pub const MIN_SIGNIFICANCE: f64 = 5.0;

/// Minimum influence of an effect on the channel that shows it best, in standard deviations of the
/// noise. Only the part that no other unknown explains counts. A smaller influence may be due to
/// any repeating disturbance.
pub const MIN_EFFECT_OVER_NOISE: f64 = 1.0;

/// Ratio of the gap to the noise floor below which the model is complete. Short records have a
/// larger limit, because their residual varies by chance; see [`FALSE_ALARM_QUANTILE`].
pub const MAX_FLOOR_RATIO_AT_FLOOR: f64 = 1.1;

/// Quantile of the normal distribution for a probability of 1 %. With this probability, the
/// residual of a correct model exceeds the limit of its training records, and likewise that of its
/// test records.
pub const FALSE_ALARM_QUANTILE: f64 = 2.326;

/// Minimum similarity of responses for the fit of an undeclared parameter or an input instead of
/// the named effect. Along the motion of an incorrect model, the gains of a sensor and of an input
/// of one linear oscillator had 0.69.
pub const MIN_SIMILARITY_TO_FIT: f64 = 0.5;

/// Similarity of two responses above which both candidates are fitted.
pub const MIN_SIMILARITY_OF_RIVALS: f64 = 0.95;

/// Relative difference below which two candidates form one class. Their held-out gaps differ by
/// less than this limit or by less than `MIN_REDUCTION_STANDARD_ERRORS`. Their training gaps differ
/// by less than this limit or by less than `MIN_INFORMATION_GAIN`. Smaller differences may be due
/// to the fit.
pub const MAX_CLASS_DIFFERENCE: f64 = 0.01;

/// Similarity of two responses above which the candidates are two names of one effect. They form
/// one class unless their residuals differ by `MIN_HELD_OUT_REDUCTION`, because windows with
/// impacts may end in different local minima.
pub const MIN_SIMILARITY_OF_SAME_EFFECT: f64 = 1.0 - 1e-6;

/// Fraction of a response that is independent of the nuisances, below which the candidate is
/// inseparable from them, unless this fraction explains `MIN_EXPLAINED_FRACTION`.
pub const MIN_UNEXPLAINED_FRACTION: f64 = 0.01;

/// Maximum number of added effects.
pub const MAX_EFFECTS: usize = 4;

/// Maximum number of full fits in one round.
pub const MAX_FULL_FITS_PER_ROUND: usize = 4;

/// Ratio of the gap to the noise floor below which no further excitation window is searched. Above
/// this ratio, another excitation window may show an effect better and change the selection.
pub const MAX_FLOOR_RATIO_TO_STOP: f64 = 1.5;

/// Remaining fraction of the residuals below which an accepted effect explains most of the gap.
/// Further effects show more clearly once this effect is in the model.
pub const MAX_REMAINING_FRACTION: f64 = 0.3;

/// Predicted reduction of the squares above which a candidate is fitted: a fifth of the reduction
/// that corresponds to `MIN_HELD_OUT_REDUCTION`, because the linear prediction is too low for
/// saturating effects such as damping.
pub const MIN_PREDICTED_REDUCTION: f64 = 0.02;

/// Minimum predicted reduction if the residuals are much larger than the noise. Effects are then
/// large, and the linear prediction is too low.
pub const MIN_PREDICTED_REDUCTION_FAR_FROM_NOISE: f64 = 0.005;

/// RMS residual above which the residuals are much larger than the noise, in standard deviations.
pub const MIN_RMS_FAR_FROM_NOISE: f64 = 3.0;

/// Maximum remaining fraction of the squares after a preliminary fit that is continued with a full
/// fit, if the gap exceeds `MAX_FLOOR_RATIO_TO_STOP` floors. None of a hundred candidates above
/// this limit was accepted.
pub const MAX_REMAINING_AFTER_PRELIMINARY_FIT: f64 = 0.95;

/// Number of candidates that are fitted in parallel before the next decision: the number of cores
/// of a small computer.
pub const PARALLEL_FIT_COUNT: usize = 2;

/// Predicted ratio of the squares of a pair to those of the best single candidate, below which the
/// pair is fitted.
pub const MAX_PAIR_COST_RATIO: f64 = 0.8;

/// Ratio of the influence of either effect to that of both, above which two effects cancel. With
/// less noise, neither effect would be selected.
pub const MIN_CANCELLATION_RATIO: f64 = 3.0;

/// Fraction of the gap that makes further candidates unnecessary. Effects that repeat with an
/// angle, a dozen for each angle, are screened only if no other candidate has this predicted
/// reduction. A candidate with this predicted reduction is always fitted, even if it is similar to
/// the nuisances.
pub const MIN_EXPLAINED_FRACTION: f64 = 0.5;

/// Maximum number of candidates, or pairs, with a preliminary fit in one round.
pub const MAX_PRELIMINARY_FITS: usize = 8;

/// Ratio of the squares to those of the best preliminary fit, below which a candidate is fitted in
/// full.
pub const MAX_RIVAL_COST_RATIO: f64 = 1.5;

/// Maximum distance of a parameter from 0, in standard deviations of its prior, for which its term
/// may be deleted.
pub const MAX_PRIOR_SD_TO_ZERO: f64 = 3.0;

/// Limit of the null model for declared parameters and sensors, in standard deviations of their
/// priors. A larger deviation, by `MIN_REDUCTION_STANDARD_ERRORS` standard deviations of the
/// estimate, is an effect; one in four hundred occurs by chance.
pub const MAX_PRIOR_DEVIATION: f64 = 3.0;

/// Factor on the linearised uncertainty of effects. The linearisation omits signal-dependent
/// quantisation, correlated initial states and the curvature of the model. Without the factor, two
/// thirds of forty test estimates were within 1.645 standard deviations.
pub const UNCERTAINTY_FACTOR: f64 = 1.8;

/// Fraction of the misfit above the noise floor that resembles the response of an effect and
/// therefore biases its size. Chosen on one seed of the blind suite with 62 sizes.
pub const MISFIT_SIMILARITY: f64 = 0.3;

/// Minimum fraction of the squares that a reported residual force explains. In all records of
/// complete models the fraction was smaller.
pub const MIN_FORCE_FRACTION: f64 = 0.1;

/// Minimum explained fraction of a force that is reported as a function of rate or position,
/// relative to a force that is free in each window.
pub const MIN_STATE_FRACTION: f64 = 0.6;

/// Minimum explained fraction of one or two simple functions that describe the force, relative to a
/// piecewise linear force.
pub const MIN_SIMPLE_FRACTION: f64 = 0.9;

/// Fraction, relative to the best equation, above which a force in another equation explains nearly
/// as much.
pub const MIN_FRACTION_OF_BEST: f64 = 0.9;

/// Relative error of the linearised force along an incorrect motion: hidden springs and friction
/// were estimated with errors of 1 to 5 %.
pub const LINEARISATION_ERROR: f64 = 0.05;

/// Ratio of the gap to the noise floor, on training and on test records, above which an empirical
/// expression is searched. A smaller gap may remain from the fit of the named effects.
pub const MIN_FLOOR_RATIO_FOR_EXPRESSION: f64 = 2.0;

/// Minimum closure of an accepted empirical expression, on training and on test records. A missing
/// function of rates, positions and inputs can reach it; other effects cannot.
pub const MIN_EXPRESSION_CLOSURE: f64 = 0.5;

/// Maximum number of terms of an empirical expression. More terms are unreadable.
pub const MAX_EXPRESSION_TERMS: usize = 3;

/// Minimum fraction of the remaining squares that each further term explains.
pub const MIN_TERM_REDUCTION: f64 = 0.25;

/// Maximum number of equations of motion in which an expression is searched, among those whose
/// force explains nearly as much. Stiffly coupled equations are inseparable.
pub const MAX_EXPRESSION_EQUATIONS: usize = 3;

// Models and their records.

/// Maximum interpolation error of the output of a delayed sensor, as a fraction of the noise.
pub const MAX_INTERPOLATION_ERROR: f64 = 0.25;

/// Maximum number of computed outputs per sample interval. A motion that needs more is
/// undersampled.
pub const MAX_OUTPUTS_PER_SAMPLE: usize = 4;

/// Cut-off frequency of the zero-phase smoothing, as a fraction of the sampling frequency. Faster
/// components of an initial value are noise or quantisation.
pub const SMOOTHING_CUT_OFF_FRACTION: f64 = 0.02;

/// Number of samples for the initial value and slope of a column. A dozen samples average the
/// noise, and a parabola still fits the motion.
pub const INITIAL_SLOPE_SAMPLE_COUNT: usize = 12;

/// Number of samples at the beginning of a record that are compared with the model. Later the
/// motion deviates too much because of missing effects.
pub const CHECKED_SAMPLE_COUNT: usize = 1000;

/// Minimum detrended motion of a channel that is compared with the model, in standard deviations of
/// its noise.
pub const MIN_CHECKED_MOTION_IN_NOISE: f64 = 20.0;

/// Correlation above which two columns contain the same quantity.
pub const MIN_SAME_CORRELATION: f64 = 0.98;

/// Correlation with the model below which a channel does not follow the model. Most of the motion
/// does not depend on the missing effects.
pub const MAX_WRONG_CORRELATION: f64 = 0.5;

/// Relative tolerance of a known unit factor between columns: 1 % for wrong parameters and 1 % for
/// missing effects.
pub const FACTOR_TOLERANCE: f64 = 0.02;

/// Tolerance of a factor of 1 or -1 between a column and the model. Missing effects may change the
/// amplitude by this fraction.
pub const UNIT_FACTOR_TOLERANCE: f64 = 0.2;

/// Maximum number of switches per simulated second of a trial motion, in 1/s: ten times that of the
/// stiffest contact of the shipped models.
pub const MAX_SWITCHES_PER_SECOND: f64 = 1e5;

/// Maximum number of substeps of one step between samples. A faster process, such as a drive lag of
/// a thousandth of a sample, is not visible, and each substep costs time.
pub const MAX_PARTS_PER_STEP: f64 = 4096.0;

/// Number of samples on which the number of steps per sample is tested.
pub const STEP_TEST_SAMPLE_COUNT: usize = 100;

/// Base-2 logarithm of the maximum number of fixed steps per sample. Above it a solver with error
/// control is used.
pub const MAX_STEP_DOUBLINGS: u32 = 7;

/// Number of steps per sample of the explicit solver with error control above which the implicit
/// solver is tried. For bristles that yield within 2 um, the explicit solver needs 1500 evaluations
/// of the rates per sample. The implicit solver needs 18, each at five times the cost.
pub const MAX_EXPLICIT_STEPS_PER_SAMPLE: u64 = 10;

/// Maximum RMS error of fixed steps in a compared simulation, in standard deviations of the noise.
pub const MAX_STEP_ERROR: f64 = 0.2;

/// Maximum root of the summed squared errors of fixed steps over all measured values, in standard
/// deviations of the noise. The errors shift each estimate by at most this fraction of its standard
/// deviation.
pub const MAX_SUMMED_STEP_ERROR: f64 = 0.1;

/// Relative tolerance of the solver with error control: far below the noise of any sensor.
pub const SOLVER_TOLERANCE: f64 = 1e-7;

/// Maximum number of steps of the solver with error control in one window: some seconds of
/// computation.
pub const MAX_SOLVER_STEPS: u64 = 400_000;

// Fits.

/// Successive fractions of a window over which initial states are fitted. A short motion is nearly
/// linear in its initial state. Chosen on the development seeds of the blind suite.
pub const INITIAL_STATE_HORIZONS: [f64; 4] = [0.08, 0.25, 0.5, 1.0];

/// Fractions of a second attempt. If impacts make the outputs non-monotonic in the initial state,
/// one sequence may end in a wrong local minimum and the other in the correct one.
pub const OTHER_INITIAL_STATE_HORIZONS: [f64; 5] = [0.05, 0.12, 0.3, 0.7, 1.0];

/// Number of chains of windows that are estimated in parallel, each from initial states of another
/// estimate. It does not depend on the machine, so that results do not either.
pub const PARALLEL_CHAIN_COUNT: usize = 2;

/// Relative decrease of the cost below which the continuation ends: each step simulates all windows
/// again.
pub const MIN_CONTINUATION_DECREASE: f64 = 0.02;

/// Maximum number of secant steps if derivatives fail. Chosen on the development seeds of the blind
/// suite.
pub const MAX_SECANT_STEPS: usize = 6;

/// First change of an unknown for a secant, as a fraction of its scale.
pub const FIRST_SECANT_IN_SCALES: f64 = 0.1;

/// Output change of a secant, as a fraction of the residuals: far above the small irregularities
/// due to impacts, and no larger than the error of the estimate.
pub const SECANT_OUTPUT_CHANGE: f64 = 0.3;

/// Factor within which the output change of a secant is accepted.
pub const SECANT_CHANGE_TOLERANCE: f64 = 3.0;

/// Relative decrease of the cost below which Gauss-Newton steps end: far below the thresholds for
/// an effect.
pub const MIN_GAUSS_NEWTON_DECREASE: f64 = 1e-3;

/// Successive trial fractions of a step of the unknowns.
pub const STEP_FRACTIONS: [f64; 3] = [1.0, 0.3, 0.05];

/// Successive damping factors of a step of the unknowns if no fraction of it decreases the cost, in
/// norms of the columns.
pub const STEP_DAMPING: [f64; 4] = [0.0, 0.03, 1.0, 30.0];

/// Successive damping factors of the step of an initial state, in weights of its prior. If impacts
/// make the outputs irregular, only short steps along well determined directions decrease the cost.
pub const INITIAL_STATE_DAMPING: [f64; 5] = [0.0, 1e2, 1e4, 1e6, 1e9];

/// Maximum number of steps of an initial state over one fraction of a window.
pub const MAX_INNER_STEPS: usize = 6;

/// Maximum number of Gauss-Newton steps over whole windows before their initial states are
/// estimated again. Chosen on the development seeds of the blind suite.
pub const MAX_FULL_STEPS: usize = 4;

/// Maximum number of further steps over the initial segments of windows before whole windows are
/// fitted.
pub const MAX_FURTHER_STEPS: usize = 12;

/// RMS residual over whole windows, in standard deviations, above which the initial states are not
/// estimated again. Also the ratio to the RMS of a fit above which initial values are rejected.
pub const MAX_RMS_TO_CONTINUE: f64 = 8.0;

/// Ratio of the training RMS after the first steps to the RMS of the warm-start fit, above which
/// the result is judged without further steps.
pub const MAX_WARM_START_RATIO: f64 = 3.0;

/// Maximum number of renewed estimates of the initial states.
pub const MAX_REFRESHES: usize = 2;

/// Relative decrease of the cost below which the initial states are not estimated again.
pub const MIN_REFRESH_DECREASE: f64 = 0.005;

/// Maximum number of windows for the linearisation of candidates, spread evenly over the records.
/// Screening a hundred candidates then costs less than one full fit.
pub const MAX_SCREENING_WINDOWS: usize = 40;

/// Number of windows for the comparison of a few equations of motion.
pub const COMPARISON_WINDOW_COUNT: usize = 20;

/// Number of blocks of time for standard errors of a set of windows. Each block is longer than the
/// correlation of the residuals.
pub const TIME_BLOCK_COUNT: usize = 40;

/// Maximum number of steps of the continuation.
pub const MAX_CONTINUATION_STEPS: usize = 5;

/// Maximum number of steps of a preliminary fit if initial states are read from the record.
pub const MAX_PRELIMINARY_STEPS: usize = 3;

/// Output change of a difference quotient, as a fraction of the residuals: far above rounding and
/// the small irregularities due to impacts.
pub const QUOTIENT_OUTPUT_CHANGE: f64 = 0.3;

/// Maximum difference for a quotient, as a fraction of the range of the state.
pub const MAX_QUOTIENT_IN_RANGES: f64 = 0.03;

/// Fraction of each window, from its beginning, for preliminary fits. In this segment the motion is
/// nearly linear in the unknowns. Chosen on the development seeds of the blind suite.
pub const PRELIMINARY_FRACTION: f64 = 0.25;

/// Number of initial-state horizons of a preliminary fit.
pub const PRELIMINARY_HORIZON_COUNT: usize = 2;

/// Relative decrease of the cost of a window below which the steps of its initial state end.
pub const MIN_INNER_DECREASE: f64 = 1e-2;

/// Autocorrelation below which residuals are uncorrelated. White noise of a few hundred samples
/// reaches this by chance.
pub const MIN_AUTOCORRELATION: f64 = 0.05;

/// Tolerance of the time between samples, as a fraction of a step, for which no further step is
/// used.
pub const SAMPLING_JITTER: f64 = 0.1;

/// Difference for the quotient with respect to a parameter, as a fraction of its scale.
pub const PARAMETER_QUOTIENT_IN_SCALES: f64 = 0.01;

/// Difference for a central quotient, as a fraction of the scale of a parameter or the range of a
/// state: far above rounding. The error of the quotient is proportional to its square.
pub const CENTRAL_QUOTIENT_IN_SCALES: f64 = 0.001;

/// Maximum number of final Gauss-Newton steps. A poorly determined direction is a curved valley of
/// the cost and needs short steps.
pub const MAX_FINAL_STEPS: usize = 12;

/// Maximum number of corrections of the initial states after a step of the unknowns. Each
/// correction removes most of the remaining error.
pub const MAX_STATE_CORRECTIONS: usize = 4;

/// Ratio of the prior weight after the final steps to the prior weight before them, below which the
/// steps are repeated with the new weight.
pub const MAX_WEIGHT_DECREASE: f64 = 0.5;

/// Decrease of the cost, in squared standard deviations, below which the final steps end.
pub const MIN_FINAL_DECREASE: f64 = 0.01;

/// Difference for the quotient with respect to a sensor unknown, as a fraction of its scale. The
/// outputs are linear in sensor unknowns.
pub const SENSOR_QUOTIENT_IN_SCALES: f64 = 0.1;

// The catalogue.

/// Maximum size of an effects file of the user, in bytes: a thousand effects.
pub const MAX_EFFECTS_FILE_BYTES: u64 = 1 << 20;

/// Shaft orders, in periods per turn, of periodic candidates, in addition to numbers of teeth:
/// orders of unbalance, joints, small pinions and motor poles.
pub const SHAFT_ORDERS: [u32; 8] = [1, 2, 3, 4, 6, 8, 12, 24];

/// Maximum order, in periods per turn, in the spectrum of the residual force over an angle: more
/// than twice the number of poles of usual motors.
pub const MAX_SHAFT_ORDER: u32 = 48;

/// Maximum number of orders from the spectrum, per angle, in addition to `SHAFT_ORDERS`.
pub const MAX_SPECTRUM_ORDERS: usize = 4;

/// Maximum number of neighbouring orders that are fitted for a named wave. In a record of 1.2
/// turns, the order of the spectral peak was wrong by two.
pub const MAX_FOLLOWED_ORDERS: usize = 8;

// Screening.

/// Relative change of the accelerations for the linearisation of a candidate: small, but large
/// compared with rounding.
pub const LINEARISATION_ACCELERATION_CHANGE: f64 = 1e-4;

/// Factors within which the relative change of the accelerations is accepted.
pub const LINEARISATION_CHANGE_FACTORS: Interval = Interval::new(0.1, 1e3);

/// Ratio of successive sizes within which the search for a size ends. It is close to 1, so that
/// results do not depend on units.
pub const SAME_SIZE_FACTORS: Interval = Interval::new(1.0 - 1e-9, 1.0 + 1e-9);

/// Stride of the samples of a window in the search for a size.
pub const SIZE_SAMPLE_STRIDE: usize = 5;

/// Output change of a simulated response, as a fraction of the residuals.
pub const RESPONSE_OUTPUT_CHANGE: f64 = 0.3;

/// Fractions of the predicted size from which a fit starts; the best start is used. The linear
/// prediction is too large if impacts make the outputs irregular, and too small for effects that
/// saturate.
pub const INITIAL_SIZE_FRACTIONS: [f64; 5] = [1.0, 0.3, 0.1, 3.0, 10.0];

/// Factors of the typical shape from which a fit is started again.
pub const SHAPE_RESTART_FACTORS: [f64; 2] = [0.4, 2.5];

/// Maximum number of corrections of a size that is close to the target. Each correction costs a
/// simulation.
pub const MAX_SIZE_CORRECTIONS: usize = 2;

/// Maximum number of attempts to find the size for a linearisation or simulation.
pub const MAX_SIZE_ATTEMPTS: usize = 8;

/// Maximum change of the size per attempt, as a factor.
pub const MAX_SIZE_FACTOR: f64 = 1e6;

/// Factors of `RESPONSE_OUTPUT_CHANGE` within which a response is accepted.
pub const RESPONSE_CHANGE_FACTORS: Interval = Interval::new(0.2, 5.0);

// The residual force.

/// Shaft orders, in periods per turn, of the profile of a residual force.
pub const FORCE_ORDERS: [u32; 10] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 36];

/// Maximum number of frequencies of the profile of a residual force.
pub const MAX_FORCE_FREQUENCIES: usize = 12;

/// Number of knots of a force over a whole turn.
pub const TURN_KNOT_COUNT: usize = 12;

/// Width of the transition at the reversal of the rate, as a fraction of the largest rate.
pub const TURNING_RATE_FRACTION: f64 = 1e-3;

/// Output change due to a trial force, as a fraction of the residuals.
pub const FORCE_OUTPUT_CHANGE: f64 = 0.3;

/// Relative change of the accelerations due to the first trial force.
pub const FIRST_FORCE_ACCELERATION_CHANGE: f64 = 1e-4;

/// Factor within which the output change of a trial force is accepted.
pub const FORCE_CHANGE_FACTOR: f64 = 10.0;

/// Factor by which a trial force is reduced if its motion leaves the domain of the model.
pub const FORCE_REDUCTION_FACTOR: f64 = 1e3;

/// Number of iterations for the variance of a force that differs between windows. After these
/// iterations it changes by less than 1 %.
pub const VARIANCE_ITERATION_COUNT: usize = 12;

/// Maximum standard deviation of a drawn point of a profile, as a fraction of the largest force.
pub const MAX_DRAWN_SD: f64 = 0.5;

/// Maximum standard deviation of a value that sets the scale of a profile, relative to the median of
/// the standard deviations.
pub const MAX_SD_OVER_MEDIAN: f64 = 10.0;

/// Minimum number of points of a drawn profile.
pub const MIN_DRAWN_POINT_COUNT: usize = 2;

/// Number of knots of a force over the rate for each direction of motion.
pub const RATE_KNOT_COUNT: usize = 5;

/// Number of knots of a force over the position.
pub const POSITION_KNOT_COUNT: usize = 9;

/// Number of knots of a force over the time of a window.
pub const TIME_KNOT_COUNT: usize = 8;

/// Number of profile frequencies that are the lowest whole numbers of periods per window.
pub const HARMONIC_FREQUENCY_COUNT: usize = 4;

/// Ratio between successive higher frequencies.
pub const FREQUENCY_RATIO: f64 = 1.6;

/// Minimum number of samples per period.
pub const MIN_SAMPLES_PER_PERIOD: f64 = 4.0;

// Expressions without a name.

/// Maximum degree of a product. Expressions of higher degree differ only near the ends of the
/// range.
pub const MAX_PRODUCT_DEGREE: u32 = 3;

/// Trial positions of a kink of a force over a position, on each side, as fractions of the largest
/// position. The position of the kink is fitted afterwards.
pub const KINK_FRACTIONS: [f64; 4] = [0.2, 0.4, 0.6, 0.8];

/// Width of the smoothed sign over the rate, as a fraction of the largest rate. Measured friction
/// near zero rate is rarely steeper, and a smooth factor can be multiplied.
pub const SIGN_WIDTH_FRACTION: f64 = 0.03;

// The report.

/// Remaining gap of a channel, in noise floors, above which the name of an effect is provisional.
/// The gap was 41 when an end stop was named as friction and a spring.
pub const MAX_FLOORS_FOR_CERTAINTY: f64 = 3.0;

/// Maximum number of unknowns of named effects that do not reach the noise floor. Six unknowns
/// imitated the weight of a beam and its payload, with a gap of 1.3 noise floors.
pub const MAX_UNKNOWNS_ABOVE_FLOOR: usize = 3;

/// Maximum gap of a channel for a correct model, in noise floors. The noise of each record is
/// different.
pub const MAX_FLOORS_OF_CORRECT_MODEL: f64 = 1.5;

/// Maximum relative error of the noise estimated from the samples of a record. The estimate is 15 %
/// low in one of twenty motions with 500 samples.
pub const MAX_ERROR_OF_NOISE_ESTIMATE: f64 = 0.2;

/// Minimum noted deviation of a nuisance from its prior, and of a size with a member of a class from
/// the reported size, in standard deviations. One in twenty is larger by chance. A constant force of 1 N on an axis with a spring caused a bias of 2.5.
pub const MIN_NOTED_DEVIATION: f64 = 2.0;

/// Fraction of `MAX_PRIOR_DEVIATION` above which a nuisance is at its bound, because estimates
/// reach the bound only within rounding.
pub const BOUND_FRACTION: f64 = 0.99;

/// Minimum ratio of the smallest to the largest delay of channels with a common delay.
pub const MIN_DELAY_RATIO: f64 = 0.9;

/// Lead of a channel that held inputs explain, in sample intervals: half an interval with its
/// uncertainty.
pub const HALF_INTERVAL_LEAD: std::ops::Range<f64> = 0.35..0.65;

/// Minimum lead of a channel, in standard deviations of its estimate.
pub const MIN_LEAD_DEVIATIONS: f64 = 3.0;

/// Minimum fraction of samples at which an input changes if it is treated as continuous.
pub const MIN_CHANGING_FRACTION: f64 = 0.5;

/// Minimum change of an estimate that is written back if no effect was found, in standard
/// deviations of the estimate. With an effect, all estimates are written because they were
/// estimated together.
pub const MIN_WRITTEN_CHANGE_IN_SD: f64 = 0.5;

/// Minimum ratio of a spectral peak to the mean of the other lines, before division by the root of
/// the number of windows. One spectrum of white noise in about a thousand has such a line.
pub const MIN_SPECTRAL_PEAK_RATIO: f64 = 10.0;

/// First line of the spectrum of a window that is interpreted as a frequency. Fewer periods per
/// window cannot be distinguished from drift, which detrending and the taper spread over the first
/// lines.
pub const FIRST_SPECTRAL_LINE: usize = 3;

/// Minimum reported ratio between the residuals of slow and of fast motion.
pub const MIN_SPEED_RATIO: f64 = 1.5;

/// Ratio of the RMS of the joint fit to the RMS of the fits of single records, above which records
/// contradict each other. A missing effect changes the parameters slightly in each record.
pub const MIN_CONTRADICTION_RATIO: f64 = 2.0;

/// Minimum relative difference of the values in contradicting records. The parameters of one
/// machine vary by less between two days.
pub const MIN_CONTRADICTION_DIFFERENCE: f64 = 0.1;

// The next experiment.

/// Minimum residual RMS of the wrong member of a class in the channel that shows it best, in
/// standard deviations of the noise: three noise floors.
pub const MIN_SEPARATION_IN_NOISE: f64 = 3.0;

/// Maximum number of samples of an experiment without a given duration. It limits the cost, because
/// a hundred experiments are simulated.
pub const MAX_EXPERIMENT_SAMPLES: f64 = 4000.0;

/// Maximum mean number of solver steps, and of switches, per sample of an experiment. Experiments
/// with a slower simulation are skipped, such as a load that is held by friction. Rattling teeth
/// cause a few switches per sample.
pub const MAX_EXPERIMENT_STEPS_PER_SAMPLE: usize = 20;

/// Trial amplitudes of an input, as fractions of its range. Large amplitudes may violate the
/// limits.
pub const EXPERIMENT_AMPLITUDES: [f64; 6] = [1.0, 0.5, 0.25, 0.1, 0.05, 0.02];

/// Maximum number of expanded terms in a compared rate of a spring or damper. Rates of real
/// machines have a handful of terms.
pub const MAX_RATE_TERMS: usize = 64;

/// Maximum power in a compared rate of a spring or damper.
pub const MAX_RATE_POWER: u8 = 8;

/// Fraction of the power of a recorded input that defines its frequency band.
pub const RECORDED_POWER_FRACTION: f64 = 0.99;

/// Fraction of the recorded range by which a channel of an experiment may exceed this range:
/// records of one motion differ by as much.
pub const LIMIT_MARGIN_FRACTION: f64 = 0.05;

/// Number of experiments, the best by linear prediction, for which the rivals are fitted again.
pub const MAX_REFITTED_EXPERIMENTS: usize = 3;

/// Minimum separation by linear prediction of an experiment that shows a small effect:
/// `MIN_SEPARATION_IN_NOISE` less the error of the linearisation.
pub const MIN_LINEAR_SEPARATION: f64 = 2.0;

/// Maximum number of untestable effects for which an experiment is searched. The experiment for one
/// effect often shows the next.
pub const MAX_DETECTION_SEARCHES: usize = 3;

/// Output change of a small effect, in standard deviations of the noise. The linearisation is valid
/// for it.
pub const SMALL_EFFECT_IN_NOISE: f64 = 3.0;

/// Factors within which the output change of a small effect is accepted.
pub const SMALL_EFFECT_FACTORS: Interval = Interval::new(1.0, 10.0);

/// Maximum number of steps of the fit of a rival. A rival that is not fully converged would appear
/// to be separated.
pub const MAX_REFIT_STEPS: usize = 30;

/// Successive trial fractions of a step of the fit of a rival.
pub const REFIT_STEP_FRACTIONS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];

/// Maximum number of Newton steps for the inputs of a given motion. One step suffices if the
/// accelerations are linear in the inputs.
pub const MAX_INVERSE_DYNAMICS_STEPS: usize = 12;

/// Minimum difference for the quotient with respect to an input of a given motion, as a fraction of
/// the input.
pub const MIN_INVERSE_DYNAMICS_QUOTIENT: f64 = 1e-6;

/// Maximum relative error of the accelerations at the inputs of a given motion: far above rounding
/// in a regular system, far below the resolution of any sensor.
pub const MAX_INVERSE_DYNAMICS_ERROR: f64 = 1e-9;

/// Maximum number of samples of the reference motion of all training records; half as many for the
/// test records. With these samples, the scan of a law takes about a second.
pub const MAX_REFERENCE_SAMPLES: usize = 3000;

/// Trial standard deviations of the change of an unknown acceleration from sample to sample, in
/// usual accelerations; the likeliest is used.
pub const ACCELERATION_STEPS: [f64; 3] = [0.02, 0.2, 1.0];

/// Least usual acceleration of a state. It moves the state through this fraction of its range in
/// one sample interval.
pub const MIN_ACCELERATION_IN_RANGES: f64 = 1e-3;

/// Step of difference quotients with respect to a state along a reference motion, in ranges of the
/// state.
pub const REFERENCE_QUOTIENT_IN_RANGES: f64 = 1e-6;

/// Step of the difference quotient with respect to an added state, relative to the state and its
/// change.
pub const ADDED_STATE_QUOTIENT: f64 = 1e-4;

/// Length of a segment of a reference motion, in windows. In a longer segment, errors of the
/// reference motion are integrated twice. For friction that yields by 0.1 mm, the residual over
/// whole windows of 0.5 s was 40 noise floors.
pub const SEGMENT_FRACTION: f64 = 0.2;

/// Minimum number of samples of a segment.
pub const MIN_SEGMENT_SAMPLES: usize = 12;

/// Decades around its typical size over which a shape is scanned.
pub const SHAPE_SCAN_DECADES: (f64, f64) = (-3.0, 1.0);

/// Decades around the typical size over which a law with a single parameter is scanned.
pub const SIZE_SCAN_DECADES: (f64, f64) = (-6.0, 4.0);

/// Number of scanned values per decade.
pub const SCANNED_VALUES_PER_DECADE: f64 = 4.0;

/// Number of refinements around the best scanned value; each halves the logarithmic interval.
pub const SCAN_REFINEMENT_COUNT: usize = 4;

/// Number of knots of a curve. They resolve a twentieth of the range, and less around zero.
pub const CURVE_KNOT_COUNT: usize = 21;

/// Fraction of the samples beyond the knots of a curve at each end.
pub const CURVE_TAIL: f64 = 0.002;

/// Penalty on the level of a curve relative to the penalty on its second differences: small, but
/// large enough for a positive definite matrix.
pub const CURVE_LEVEL_PENALTY: f64 = 1e-4;

/// Decades over which the penalty of a curve is tried, relative to the information of the records.
pub const CURVE_PENALTY_DECADES: (f64, f64) = (-10.0, 2.0);

/// Correlation of residuals at which the sum over lags ends.
pub const MIN_LAG_CORRELATION: f64 = 0.05;

/// Maximum ratio of the residual of a scanned law to the smallest residual of all scanned laws for
/// which the law is fitted.
pub const MAX_SCANNED_RIVAL_RATIO: f64 = 2.0;

/// Maximum number of evaluations of the rates in the fit of a scanned law, per training sample. The
/// fit of Dahl friction needs 10,000, on a record without noise 50,000 to 200,000.
pub const MAX_FIT_EVALUATIONS_PER_SAMPLE: u64 = 200_000;

/// Maximum ratio of the held-out residual of a curve to its training residual. For a wrong pair the
/// ratio was 2 to 26.
pub const MAX_HELD_OUT_RATIO: f64 = 1.5;

/// Maximum remaining fraction of the residual with an adequate curve. Also the maximum remaining
/// fraction of the gap to the noise floor with a law, along the reference motion. With a correct
/// law, up to 0.06 remained (a stop).
pub const MAX_REMAINING_WITH_CURVE: f64 = 0.3;
