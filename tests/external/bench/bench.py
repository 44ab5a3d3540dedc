"""A mass on a spring, shaken by its base: fourth-order Runge-Kutta, standard library only. Reads bench.in.json, writes
curve.csv. Beside stiffness and damping it knows five effects that do nothing at 0: dry friction, drag by the square of the
speed, a spring that hardens, a late sensor, an unbalance with two phases."""
import json, math

p = json.load(open("bench.in.json"))
m, speed = 2.0, 2 * math.pi * p["hz"]
n, fine, settle = 36, 4, 8


def base(t):
    return sum(a * math.sin(k * speed * t + f) for k, a, f in ((1, 3e-3, 0.0), (2, 1e-3, 0.7), (3, 4e-4, 1.9)))


def force(t, x, v):
    stretch = x - base(t)
    spring = 1e3 * p["stiffness"] * stretch * (1.0 + p["hardening"] * (1e3 * stretch) ** 2)
    turn = p["unbalance_cos"] * math.cos(speed * t) + p["unbalance_sin"] * math.sin(speed * t)
    return -spring - p["damping"] * v - p["drag"] * v * abs(v) - p["friction"] * math.tanh(v / 2e-3) + turn


step = 2 * math.pi / speed / (fine * n)
state, rows, t = (0.0, 0.0), [], 0.0
for i in range((settle + 2) * fine * n + 1):
    rows.append((t, *state))
    a = lambda h, d: (state[1] + h * d[1], force(t + h, state[0] + h * d[0], state[1] + h * d[1]) / m)
    k1 = a(0.0, (0.0, 0.0))
    k2 = a(step / 2, k1)
    k3 = a(step / 2, k2)
    k4 = a(step, k3)
    state = tuple(s + step / 6 * (w + 2 * x + 2 * y + z) for s, w, x, y, z in zip(state, k1, k2, k3, k4))
    t += step
late = p["lag_ms"] / 1e3 / step
begin = settle * fine * n
with open("curve.csv", "w") as out:
    out.write("phase_deg,travel_mm,force_n\n")
    for i in range(n):
        at = begin + fine * i - late
        low = math.floor(at)
        x, v = (rows[low][k] + (at - low) * (rows[low + 1][k] - rows[low][k]) for k in (1, 2))
        then = begin + fine * i
        tt, xx, vv = rows[then]
        out.write(f"{360.0 * i / n:.1f},{1e3 * x:.9f},{force(tt, xx, vv):.7f}\n")
