//! Validation of the equations of an extended specification.

use eomgen_compiled_model::Error;
use eomgen_validate::certificate::Verdict;
use eomgen_validate::model_certificate::certify_specification;

use super::result::{Discovery, Validation};
use crate::model::specification_texts::edited_source;

impl Discovery {
    /// Validates the extended specification and stores the result. `path`: path of the given
    /// specification; `order`: its requested order.
    ///
    /// # Errors
    ///
    /// An extended specification that cannot be read or derived.
    pub fn certify(&mut self, path: &str, order: Option<usize>) -> Result<(), Error> {
        let extended = edited_source(path, &self.extended);
        let certificate = certify_specification(extended, order)?;
        self.validation = certificate.map(|certificate| Validation {
            has_passed: certificate.verdict != Verdict::Failed,
            checks: certificate.run_checks(),
            failed: certificate.failed_checks(),
        });
        Ok(())
    }
}
