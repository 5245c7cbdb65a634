"""Propagations of a differential drive for 1 s in ten steps, by SciPy and by OMPL if they are there.

Prints a line `NAME NANOSECONDS` for each way. Run by run.rs.
"""
import math
import os
import sys
import time

L, R = 0.4, 0.1


def rate(t, x, u0, u1):
    ahead = R / 2 * (u0 + u1)
    return [ahead * math.cos(x[2]), ahead * math.sin(x[2]), R / L * (u1 - u0)]


def measure(name, count, once):
    once()
    best = math.inf
    for _ in range(5):
        begin = time.process_time()
        for _ in range(count):
            once()
        best = min(best, (time.process_time() - begin) / count * 1e9)
    print(name, best, flush=True)


def scipy():
    from scipy.integrate import odeint, solve_ivp

    x = [0.1, 0.2, 0.3]
    measure("scipy-odeint", 500, lambda: odeint(rate, x, (0.0, 1.0), args=(1.0, 2.0), tfirst=True))
    measure("scipy-rk45", 50, lambda: solve_ivp(
        rate, (0.0, 1.0), x, args=(1.0, 2.0), first_step=0.1, max_step=0.1, rtol=1.0, atol=1.0))


def ompl():
    from ompl import base, control

    def ode(q, u, out):
        out[0], out[1], out[2] = rate(0, q, u[0], u[1])

    space = base.RealVectorStateSpace(3)
    bounds = base.RealVectorBounds(3)
    bounds.setLow(-100)
    bounds.setHigh(100)
    space.setBounds(bounds)
    controls = control.RealVectorControlSpace(space, 2)
    limits = base.RealVectorBounds(2)
    limits.setLow(-5)
    limits.setHigh(5)
    controls.setBounds(limits)
    setup = control.SimpleSetup(controls)
    setup.setStateValidityChecker(base.StateValidityCheckerFn(lambda state: True))
    info = setup.getSpaceInformation()
    equations = control.ODE(ode)
    solver = control.ODEBasicSolver(info, equations, 0.1)
    setup.setStatePropagator(control.ODESolver.getStatePropagator(solver))
    info.setPropagationStepSize(1.0)
    info.setup()
    state, result = info.allocState(), info.allocState()
    state[0], state[1], state[2] = 0.1, 0.2, 0.3
    action = info.allocControl()
    action[0], action[1] = 1.0, 2.0
    measure("ompl-basic", 200, lambda: info.propagate(state, action, 1, result))
    angle = 0.3 + R / L
    radius = R / 2 * 3 / (R / L)
    assert abs(result[0] - 0.1 - radius * (math.sin(angle) - math.sin(0.3))) < 1e-6, result[0]


for peer in (scipy, ompl):
    try:
        peer()
    except Exception as missing:
        print(f"{peer.__name__}: {missing}", file=sys.stderr)
# Bindings may fail in their last clean-up.
sys.stdout.flush()
os._exit(0)
