//! The ascent to a local maximum of the smooth minimum: L-BFGS (Liu, Nocedal 1989) with the line search of Moré and Thuente
//! (1994), by the library `argmin`.

use std::cell::RefCell;

use argmin::core::{CostFunction, Error, Executor, Gradient};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;

use super::optimize::Search;

/// Steps of one ascent, and so many of them are remembered: more bring little.
const STEPS: u64 = 150;
const MEMORY: usize = 80;

/// A point, the value there and its slopes.
type Looked = (Vec<f64>, f64, Vec<f64>);

/// The smooth minimum, negative, as the library asks for it: value and slopes apart, though one comes with the other.
struct Cost<'a> {
    search: &'a Search<'a>,
    sharpness: f64,
    is_cancelled: &'a (dyn Fn() -> bool + Sync),
    last: RefCell<Looked>,
    /// Outlives the library's state, which is lost when a line search fails.
    best: &'a RefCell<(Vec<f64>, f64)>,
}

impl Cost<'_> {
    fn look(&self, free: &[f64]) -> Result<(), Error> {
        if self.last.borrow().0 == free {
            return Ok(());
        }
        if (self.is_cancelled)() {
            return Err(Error::msg("cancelled"));
        }
        let (value, mut slopes) = self.search.rise(free, self.sharpness);
        slopes.iter_mut().for_each(|slope| *slope = -*slope);
        if value > self.best.borrow().1 {
            *self.best.borrow_mut() = (free.to_vec(), value);
        }
        *self.last.borrow_mut() = (free.to_vec(), -value, slopes);
        Ok(())
    }
}

impl CostFunction for Cost<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, free: &Vec<f64>) -> Result<f64, Error> {
        self.look(free)?;
        Ok(self.last.borrow().1)
    }
}

impl Gradient for Cost<'_> {
    type Param = Vec<f64>;
    type Gradient = Vec<f64>;

    fn gradient(&self, free: &Vec<f64>) -> Result<Vec<f64>, Error> {
        self.look(free)?;
        Ok(self.last.borrow().2.clone())
    }
}

/// The best variables met on the way from some; a line search that fails ends it, and so does cancelling.
pub(super) fn ascend(
    search: &Search,
    free: &[f64],
    sharpness: f64,
    is_cancelled: &(dyn Fn() -> bool + Sync),
) -> Vec<f64> {
    let best = RefCell::new((free.to_vec(), f64::NEG_INFINITY));
    let cost = Cost { search, sharpness, is_cancelled, last: RefCell::default(), best: &best };
    let solver = LBFGS::new(MoreThuenteLineSearch::new(), MEMORY);
    let run = Executor::new(cost, solver).configure(|state| state.param(free.to_vec()).max_iters(STEPS)).timer(false);
    if let Err(reason) = run.run() {
        log::debug!("the ascent ended early: {reason}");
    }
    best.into_inner().0
}
