"""What CasADi makes of a model in C: `definitions`, a module beside this file, has its energies. Forward dynamics by
LDL' (`ldl`), inverse dynamics by the same rows, expressions that occur more than once computed once (`cse`)."""

import casadi as ca
from definitions import energies

q, v, u, p, T, V, Q = energies()
rates = ca.gradient(T, v)
mass = ca.jacobian(rates, v)
right = Q - ca.gradient(V, q) - ca.jtimes(rates, q, v) + ca.gradient(T, q)
a = ca.SX.sym("a", q.numel())
forward = ca.Function("contender_forward", [q, v, u, p], [ca.cse(ca.ldl_solve(right, *ca.ldl(mass)))])
inverse = ca.Function("contender_inverse", [q, v, u, a, p], [ca.cse(mass @ a - right)])
generator = ca.CodeGenerator("contender.c")
generator.add(forward)
generator.add(inverse)
generator.generate()
print(forward.n_instructions(), inverse.n_instructions())
