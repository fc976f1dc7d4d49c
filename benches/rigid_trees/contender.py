"""C code of CasADi for a model. The module `definitions` in the same folder has its energies. Forward dynamics use LDL'
(`ldl`), inverse dynamics the same rows; common subexpressions are computed once (`cse`)."""

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
