//! Tests of the whole program: options, output files, packages, documentation.

mod book;
mod built_once;
mod files;
mod glossary;
mod imports;
mod installed;
mod packages;
#[cfg(unix)]
mod pictures;
mod printed_commands;
#[cfg(unix)]
mod recipes;
mod shells;
mod streams;
mod usage;
