//! Origin of a result on its page.

use maud::{Markup, html};

use crate::report::origin::Origin;

/// Lists version, date, seed and files with their hashes.
pub(super) fn list_files(origin: &Origin) -> Markup {
    html! {
        p {
            "Written by eomgen " (origin.version) " on " (origin.date) " (UTC), seed " (origin.seed) "."
        }
        details {
            summary { "Files and their SHA-256" }
            dl.files {
                @for file in &origin.files {
                    dt { (file.role) ": " code { (file.path) } }
                    dd {
                        @match &file.sha256 {
                            Some(hash) => code { (hash) },
                            None => "not readable",
                        }
                    }
                }
            }
        }
    }
}
