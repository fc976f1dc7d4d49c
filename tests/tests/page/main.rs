//! `eomgen page`: the module of WebAssembly that its pages compute with, bit by bit.

mod bits;
