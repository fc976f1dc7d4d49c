"""Dynamics of `@name@` for acados, from the functions for CasADi in `@name@_casadi.c` beside this file.

Emitted by eomgen @generator@ from the specification `@model@` (SHA-256
@specification@).
Do not edit: change the specification and generate again.

    import @name@_acados

    ocp = AcadosOcp()                           # the same for AcadosSim
    ocp.model = @name@_acados.build_model()
    ocp.parameter_values = @name@_acados.default_parameters()

States, inputs and parameters are in SI units.
"""

import ctypes
import hashlib
import os
import pathlib
import subprocess

import casadi
import numpy

STATES = @states@
INPUTS = @inputs@
PARAMETERS = @parameters@

_SOURCE = pathlib.Path(__file__).resolve().with_name("@name@_casadi.c")
_FUNCTIONS = ("rates", "jac_rates", "adj1_rates", "jac_adj1_rates")
_PARTS = ("", "_n_in", "_n_out", "_name_in", "_name_out", "_sparsity_in", "_sparsity_out", "_work")


def compile_library(compiler="cc", options=("-std=c99", "-O3")):
    """Returns the name of the rates and the path of the library, which is compiled if it is missing.

    The name is that of no other source: solvers of several models or orders can be loaded together.
    """
    source = _SOURCE.read_bytes()
    name = "@name@_" + hashlib.sha256(source).hexdigest()[:16]
    library = _SOURCE.with_name(f"lib{name}.so")
    if not library.exists():
        written = library.with_name(f"{library.name}.{os.getpid()}")
        renamed = [f"-D{old}{part}={old.replace('rates', name)}{part}" for old in _FUNCTIONS for part in _PARTS]
        command = [compiler, *options, "-shared", "-fPIC", "-fvisibility=hidden", *renamed, str(_SOURCE)]
        subprocess.run([*command, "-o", str(written)], check=True)
        written.replace(library)
    return name, library


def build_model():
    """Returns the `AcadosModel` with explicit dynamics (ERK) and implicit ones (IRK)."""
    try:
        from acados_template import AcadosModel
    except ImportError:
        from acados.acados_template import AcadosModel
    name, library = compile_library()
    # The library of the solver, which acados generates, finds the functions in this one.
    ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    rates = casadi.external(name, str(library))
    model = AcadosModel()
    model.name = "@name@"
    model.x = casadi.MX.sym("x", len(STATES))
    model.xdot = casadi.MX.sym("xdot", len(STATES))
    model.u = casadi.MX.sym("u", len(INPUTS))
    model.p = casadi.MX.sym("p", len(PARAMETERS))
    model.f_expl_expr = rates(0, model.x, model.u, model.p)
    model.f_impl_expr = model.xdot - model.f_expl_expr
    return model


def default_parameters():
    """Returns the parameters of the specification, in the order of `PARAMETERS`."""
    _, library = compile_library()
    values = casadi.external("default_parameters", str(library))()["p"]
    return numpy.array(values).ravel()
