"""Models written in Python have the equations and the bits of the files of the zoo; errors name the lines of mistakes."""

import inspect
import pathlib
import re
import subprocess
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import anholon as an
import numpy as np
import pytest
from anholon import ex, ey, ez

ZOO: dict[str, Callable[[], an.Builder]] = {}


def _line() -> int:
    """Returns the line of the caller."""
    frame = inspect.currentframe()
    assert frame is not None and frame.f_back is not None
    return frame.f_back.f_lineno


def of_the_zoo(write: Callable[[an.Builder], None]) -> Callable[[an.Builder], None]:
    def build() -> an.Builder:
        b = an.Builder(name)
        write(b)
        return b

    name = write.__name__.replace("_", "-")
    ZOO[name] = build
    return write


@of_the_zoo
def disc(b: an.Builder) -> None:
    x, y, psi, theta, phi = b.coordinates("x y psi theta phi")
    m, R, g = b.parameters(m=1, R=Fraction(1, 2), g=9.81)
    lean = b.frame("lean", an.rotz(psi) * an.rotx(theta))
    contact = b.point("contact", x * ex + y * ey)
    body = b.body("disc", mass=m, shape="disc(R)", center=contact + R * lean.y, orientation=lean * an.rotz(phi))
    b.constraint("rolling", body.vel(contact) == 0)
    b.gravity(-g * ez)
    b.initial({theta: 1.3}, conditions=[psi.dt == 0.2, phi.dt == 6])
    b.simulate(to=10)


@of_the_zoo
def chaplygin_sleigh(b: an.Builder) -> None:
    x, y, th = b.coordinates("x y th")
    m, a, J = b.parameters(m=2, a=0.6, J=0.5)
    blade = b.frame("blade", an.rotz(th))
    P = b.point("P", x * ex + y * ey)
    b.body("sleigh", mass=m, inertia=J, center=P + a * blade.x, orientation=blade)
    b.constraint("blade_edge", an.dot(P.vel(), blade.y) == 0)
    b.initial({x: 0, y: 0, th: 0, x.dt: -0.5, th.dt: 1.5})
    b.simulate(to=5)


@of_the_zoo
def snakeboard(b: an.Builder) -> None:
    x, y, th, ps, ph = b.coordinates("x y th ps ph")
    m, J, Jr, mw, Jw, L = b.parameters(m=4, J=0.1, Jr=0.2, mw=0.5, Jw=0.02, L=0.4)
    A1, A2, wf, kp, cp = b.parameters(A1=0.5, A2=0.3, wf=2, kp=1, cp=0.2)
    along = b.frame("along", an.rotz(th))
    middle = b.point("middle", x * ex + y * ey)
    board = b.body("board", mass=m, inertia=J, center=middle, orientation=along)
    rotor = b.body("rotor", mass=0, inertia=Jr, center=middle, angle=th + ps)
    front = b.body("front", mass=mw, inertia=Jw, center=middle + L * along.x, angle=th + ph)
    rear = b.body("rear", mass=mw, inertia=Jw, center=middle - L * along.x, angle=th - ph)
    b.force(rotor, from_=board, torque=A1 * an.sin(wf * an.t) * ez, name="swing")
    b.force(generalized={ph: -kp * ph - cp * ph.dt + A2 * an.cos(wf * an.t)}, name="steering")
    b.constraint("front_wheels", an.vel(front.center) @ front.y == 0)
    b.constraint("rear_wheels", an.vel(rear.center) @ rear.y == 0)
    b.initial({x: 0, y: 0, th: 0.2, ps: 0, ph: 0.5, th.dt: 0.3, ps.dt: 1, ph.dt: 0})
    b.simulate(to=2)


@of_the_zoo
def rattleback(b: an.Builder) -> None:
    x, y, ps, th, ph = b.coordinates("x y ps th ph")
    m, g, ea, eb, ec, cz, dl = b.parameters(m=1, g=9.81, ea=0.2, eb=0.03, ec=0.02, cz=0.01, dl=0.1)
    e1, e2, e3 = b.parameters(e1=Fraction(3, 400), e2=Fraction(1, 4000), e3="1/8000")
    stone = b.frame("stone", an.rotz(ps) * an.rotx(th) * an.rotz(ph))
    g1, g2, g3 = (b.define(f"g{k + 1}", an.dot(ez, axis)) for k, axis in enumerate((stone.x, stone.y, stone.z)))
    h = b.define("h", an.sqrt(ea**2 * g1**2 + eb**2 * g2**2 + ec**2 * g3**2))
    middle = b.point("middle", [x, y, h])
    contact = b.point("contact", middle - (ea**2 * g1 * stone.x + eb**2 * g2 * stone.y + ec**2 * g3 * stone.z) / h)
    body = b.body("rattleback", mass=m, inertia=[e2 + e3, e3 + e1, e1 + e2], center=middle - cz * stone.z, orientation=stone * an.rotz(dl))
    b.gravity(-g * ez)
    b.constraint("rolling_x", an.dot(body.vel(contact), ex) == 0)
    b.constraint("rolling_y", an.dot(body.vel(contact), ey) == 0)
    b.initial({x: 0, y: 0, ps: 0, th: 0.05, ph: 0.5, ps.dt: -1, th.dt: 0.2, ph.dt: 3})
    b.simulate(to=1)


@of_the_zoo
def fourbar(b: an.Builder) -> None:
    a1, a2, a3 = b.coordinates("a1, a2, a3")
    L1, L2, L3, D, m1, m2, m3, g, tau = b.parameters(L1=1, L2=2, L3=1.8, D=2, m1=1, m2=2, m3=1.8, g=9.81, tau=3)
    e1, e2, e3 = (b.frame(f"e{k + 1}", an.rotz(a)) for k, a in enumerate((a1, a2, a3)))
    A = b.point("A", L1 * e1.x)
    B = b.point("B", D * ex + L3 * e3.x)
    crank = b.body("crank", mass=m1, inertia=m1 * L1**2 / 12, center=L1 / 2 * e1.x, orientation=e1)
    b.body("coupler", mass=m2, inertia=m2 * L2**2 / 12, center=A + L2 / 2 * e2.x, orientation=e2)
    b.body("rocker", mass=m3, inertia=m3 * L3**2 / 12, center=D * ex + L3 / 2 * e3.x, orientation=e3)
    b.gravity(-g * ey)
    b.force(crank, torque=tau * ez, name="motor")
    b.constraint("loop", A + L2 * e2.x == B)
    b.initial({
        a1: Decimal("1.220413574154227718892717705374830379800"),
        a2: Decimal("0.4413738773608142990207765414199809383038"),
        a3: "1.486480587070015777620570686651483293365",
        a1.dt: "0.8113241717347504145897150344027634388900",
    })
    b.simulate(to=0.8)


@of_the_zoo
def two_wheeled_pendulum(b: an.Builder) -> None:
    x, y, psi, al, left, right = b.coordinates(["x", "y", "psi", "al", "l", "r"])
    M, mw, R, axle_half, h = b.parameters(M="30 kg", mw="2 kg", R="20 cm", b="25 cm", h="50 cm")
    g, k, c = b.parameters(g="9.81 m/s^2", k="400 N*m", c="60 N*m*s")
    head = b.frame("head", an.rotz(psi))
    lean = b.frame("lean", head * an.roty(al))
    axle = b.point("axle", x * ex + y * ey + R * ez)
    hold = b.define("hold", k * al + c * al.dt)
    rider = b.body("rider", mass=M, shape="box(b, 2*b, 2*h)", center=axle + h * lean.z, orientation=lean)
    moments = [mw * R**2 / 4, mw * R**2 / 2, mw * R**2 / 4]
    wheels = [
        b.body("left", mass=mw, inertia=moments, center=axle + axle_half * head.y, orientation=head * an.roty(left)),
        b.body("right", mass=mw, inertia=moments, center=axle - axle_half * head.y, orientation=head * an.roty(right)),
    ]
    for wheel in wheels:
        b.force(wheel, from_=rider, torque=hold * head.y)
    b.constraint("left_rolls", wheels[0].vel(wheels[0].center - R * ez) == 0, along=[head.x, head.y])
    b.constraint("right_rolls", wheels[1].vel(wheels[1].center - R * ez) == 0, along=[head.x])
    b.gravity(-g * ez)
    b.initial({al: "10 deg"})
    b.simulate(to=3)


@of_the_zoo
def vertical_disc(b: an.Builder) -> None:
    x, y, th, ph = b.coordinates("x y th ph")
    m, R, tr, ts = b.parameters(m=1.5, R=0.5, tr=0.2, ts=-0.3)
    upright = b.frame("upright", an.rotz(th))
    contact = b.point("contact", x * ex + y * ey)
    inertia = [m * R**2 / 4, m * R**2 / 2, m * R**2 / 4]
    body = b.body("disc", mass=m, inertia=inertia, center=contact + R * ez, orientation=upright * an.roty(ph))
    b.force(body, torque=tr * upright.y)
    b.force(body, torque=ts * ez)
    b.constraint("rolling", body.vel(contact) == 0)
    b.initial({x: 0, y: 0, th: 0.2, ph: 0, th.dt: 0.5, ph.dt: 2})
    b.simulate(to=5)


@of_the_zoo
def roller_racer(b: an.Builder) -> None:
    x, y, th = b.coordinates("x y th")
    m, J1, J2, d1, d2, A, w = b.parameters(m="60 kg", J1="4 kg*m^2", J2="0.3 kg*m^2", d1="40 cm", d2="15 cm", A="40 deg", w="4 rad/s")
    ph = b.function("ph", A * an.sin(w * an.t))
    seat, bar = b.frame("seat", an.rotz(th)), b.frame("bar", an.rotz(th + ph))
    axle = b.point("axle", x * ex + y * ey)
    joint = b.point("joint", axle + d1 * seat.x)
    front = b.point("front", joint + d2 * bar.x)
    b.body("rider", mass=m, inertia=J1, center=axle, orientation=seat)
    b.body("handlebar", inertia=J2, center=front, orientation=bar)
    b.constraint("rear_wheels", axle.vel() @ seat.y == 0)
    b.constraint("front_wheels", front.vel() @ bar.y == 0)
    b.initial(conditions=[axle.vel() @ seat.x == 0.5])
    b.simulate(to=6)


@of_the_zoo
def constant_jerk(b: an.Builder) -> None:
    x, y, z = b.coordinates("x y z")
    m, g, c = b.parameters(m=2, g=9.81, c=3)
    b.particle("particle", mass=m, position=[x, y, z])
    b.gravity(-g * ez)
    b.constraint("jerk", x.d(3) ** 2 + y.dt.d(2) ** 2 + z.d(3) ** 2 == c**2)
    b.initial({x: 0, y: 0, z: 0, x.dt: 1, y.dt: 0, z.dt: 0.5, x.d(2): 1, y.d(2): 0.5, z.d(2): -8}, branch={"jerk": "lambda > 0"})
    b.simulate(to=2)


@of_the_zoo
def variable_mass_pendulum(b: an.Builder) -> None:
    th = b.coordinate("th")
    m0, kap, L, g, w0, a1, ux, uy = b.parameters(m0=2, kap=0.5, L=1, g=9.81, w0=0.6, a1=0.5, ux=1, uy=-0.5)
    m = b.function("m", m0 / (1 + kap * an.t))
    b.observer(spin=w0 * an.cos(an.t) * ez, origin_acceleration=a1 * an.sin(an.t) * ex)
    b.particle("bob", mass=m, position=[L * an.sin(th), -L * an.cos(th), 0], expelled_velocity=ux * ex + uy * ey)
    b.gravity(-g * ey)
    b.initial({th: 0.5, th.dt: 0})
    b.simulate(to=4)


@of_the_zoo
def launcher(b: an.Builder) -> None:
    x, y, z = b.coordinates("x y z")
    mu, RE, wE, A = b.parameters(mu="3.986004418e14 m^3/s^2", RE="6371 km", wE="7.292115e-5 rad/s", A="10 m^2")
    ms1, ms2, mp1, mp2 = b.parameters(ms1="37 t", ms2="20 t", mp1="400 t", mp2="90 t")
    stage = b.mode("stage", 1)
    P = b.point("P", x * ex + y * ey + z * ez)
    pad = b.frame("pad", an.rotz(an.atan2(y, x)))
    flow = b.define("flow", an.choose(stage, 2500, 270, 0))
    ue = b.define("ue", an.choose(stage, 2800, 3400, 0))
    fuel = b.state("fuel", rate=-flow, initial=mp1)
    mass = b.define("mass", an.choose(stage, ms1 + ms2 + mp2, ms2, ms2) + fuel)
    h = b.define("h", an.norm(P) - RE)
    v = b.define("v", P.vel())
    b.function("rho", "1.225*exp(-h/8500)", arguments=["h"])
    b.function("sound", "max(295, 340.3 - 0.0041*h)", arguments=["h"])
    q = b.define("q", an.call("rho", h) * an.norm2(v) / 2)
    b.table("Cd", [0, 0.8, 1.05, 1.5, 3, 10], [0.30, 0.32, 0.55, 0.45, 0.30, 0.25])
    b.table("pitch", [0, 10, 160, 500], [0, 0, 0.95, 1.5])
    pitch = an.call("pitch", an.t)
    rocket = b.particle("rocket", mass=mass, position=P, expelled_velocity=-ue * (an.cos(pitch) * pad.x + an.sin(pitch) * pad.y))
    b.force(rocket, -q * an.call("Cd", an.norm(v) / an.call("sound", h)) * A * an.unit(v), name="drag")
    b.event("burn_out", fuel, direction="down", set={stage: stage + 1, fuel: an.choose(stage + 1, 0, mp2, 0)})
    b.event("max_q", q.dt, direction="down")
    b.observer(spin=wE * ez)
    b.gravity(-mu / an.norm(an.here) ** 3 * an.here)
    b.output("height", h, unit="km")
    b.output("inertial_speed", an.norm(an.vel(P, "inertial")))
    b.output("load", an.norm(an.acc(P, "inertial") - "gravity(P)") / 9.80665)
    b.initial({x: RE}, conditions=[P.vel() == pad.x])
    b.simulate(to=600)


@of_the_zoo
def spherical_robot(b: an.Builder) -> None:
    x, y, e0, e1, e2, e3, al, be = b.coordinates("x y e0 e1 e2 e3 al be")
    M, R, m, length, g = b.parameters(M="3 kg", R="20 cm", m="4 kg", l="12 cm", g="9.81 m/s^2")
    A, w, k, c = b.parameters(A="1.5 N*m", w="2 rad/s", k="2 N*m", c="0.1 N*m*s")
    b.gravity(-g * ez)
    center = b.point("center", x * ex + y * ey + R * ez)
    b.potential("spring", k / 2 * be**2)
    b.dissipation("damper", c / 2 * be.dt**2)
    shell = b.frame("shell", an.quat(e0, e1, e2, e3))
    arm = b.frame("arm", shell * an.roty(al) * an.rotx(be))
    ball = b.body("ball", mass=M, shape="shell(R)", center=center, orientation=shell)
    b.particle("bob", mass=m, position=center - length * arm.z)
    b.force(generalized={al: -A * an.sin(w * an.t)}, name="motor")
    b.constraint("rolling", ball.vel(center - R * ez) == 0)
    b.initial(conditions=[ball.angvel == [0, 2, 0], al.dt == -2])
    b.simulate(to=2)


@of_the_zoo
def tether_by_servo(b: an.Builder) -> None:
    length, angle = b.coordinates("l angle")
    mu, R, m, l0, slope = b.parameters(mu="3.986004418e14 m^3/s^2", R="6778 km", m="100 kg", l0="50 m", slope="-10 deg")
    line = b.frame("line", an.rotz(angle))
    P = b.point("P", length * line.x)
    n = b.define("n", an.sqrt(mu / R**3))
    pull = b.input("pull")
    satellite = b.particle("satellite", mass=m, position=P)
    b.force(satellite, -pull * line.x, name="motor")
    b.constraint("reel", angle == slope, by=pull)
    b.gravity(-mu / an.norm(R * ex + an.here) ** 3 * (R * ex + an.here))
    b.observer(spin=n * ez, origin_acceleration=-(n**2) * R * ex)
    b.output("tension", m * an.norm(an.acc(P, "inertial") - an.call("gravity", P)))
    b.initial({length: l0, angle: slope})
    b.simulate(to=9000)


@pytest.mark.parametrize("name", ZOO)
def test_the_equations_of_the_file(name: str) -> None:
    built, read = ZOO[name]().model(), an.load(name)
    assert [c.name for c in built.coordinates] == [c.name for c in read.coordinates]
    assert built.parameters == read.parameters
    forms = [form.name for form in read.forms() if form.applies]
    assert forms == [form.name for form in built.forms() if form.applies]
    for form in forms[:4]:
        ours, theirs = (re.sub(r"in line \d+", "in a line", model.equations(form).text) for model in (built, read))
        assert ours == theirs.replace(read.title, built.title)


@pytest.mark.parametrize("name", ZOO)
def test_the_bits_of_the_file(name: str) -> None:
    built, read = ZOO[name]().model(), an.load(name)
    ours, theirs = (model.simulate(error_estimate=False) for model in (built, read))
    assert list(ours) == list(theirs) and len(ours) == len(theirs) > 1 and ours.outcome.kind == theirs.outcome.kind
    for column in ours:
        assert ours[column].tobytes() == theirs[column].tobytes(), column
    assert [repr(e) for e in ours.events] == [repr(e) for e in theirs.events]


@pytest.mark.parametrize("name", ZOO)
def test_the_program_reads_the_text(name: str, program: Callable[..., str], tmp_path: pathlib.Path) -> None:
    path = tmp_path / "built.toml"
    path.write_text(ZOO[name]().text, encoding="utf-8")
    assert "degrees of freedom" in program("check", str(path), "--quiet")


def bead() -> tuple[an.Builder, an.Expr, an.Expr]:
    b = an.Builder("a bead")
    x, y = b.coordinates("x y")
    b.particle("bead", mass=1, position=[x, y, 0])
    return b, x, y


def test_mistakes_name_the_line_of_python() -> None:
    b, x, y = bead()
    b.monitor("fine", x)
    b.constraint("wire", y == "xx^2")  # the mistake
    b.monitor("product", an.vel("bead") * ez)  # another one
    with pytest.raises(an.ModelError) as caught:
        b.model()
    text = str(caught.value)
    own = pathlib.Path(__file__).read_text(encoding="utf-8").splitlines()
    for mark, message in (("# the mistake", "unknown name 'xx'"), ("# another one", "product of two vectors")):
        (line,) = (k + 1 for k, t in enumerate(own) if t.endswith(mark))
        assert f"test_builder.py:{line}: error:" in text and message in text and own[line - 1].strip() in text
    assert "^^" in text and len(caught.value.diagnostics) == 2
    assert b.text.splitlines()[caught.value.diagnostics[0].line - 1] == 'equation = "y = xx^2"'


def test_a_call_with_other_things_is_refused() -> None:
    b, x, y = bead()
    with pytest.raises(TypeError, match="an equation is written a == b"):
        b.constraint("no", x - y)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="piecewise"):
        bool(x > 1)
    with pytest.raises(TypeError, match="three components"):
        an.expr([1, 2])
    with pytest.raises(TypeError):
        an.expr(1j)
    with pytest.raises(an.MotionError):
        b.constraint("wire", y == x**2)
        b.initial({x: 1, y: 2})
        b.model(check=True)


def number(term: Any) -> float:
    """Returns the value of a formula at x = 3, y = 5, computed by the library."""
    b, x, y = bead()
    b.initial({x: 3, y: 5, x.dt: 2, y.dt: 0})
    b.monitor("value", term)
    return float(b.model().simulate(to=1, at=[0], error_estimate=False)["value"][0])


def test_texts_mean_what_python_means() -> None:
    x, y = an.expr("x"), an.expr("y")
    a, b = 3.0, 5.0
    for ours, theirs in (
        (-(x**2), -(a**2)),
        ((-x) ** 2, a**2),
        (2 ** x**2, 2 ** a**2),
        ((2**x) ** 2, (2**a) ** 2),
        (x - (y - x), a - (b - a)),
        (x / (y * x), a / (b * a)),
        (x / y * x, a / b * a),
        (x * (y / x), a * (b / a)),
        (x - y + x, a - b + a),
        (x + -y, a - b),
        (x - -y, a + b),
        (-x * y, -a * b),
        (x * -y, -a * b),
        (2 - x, 2 - a),
        (2 / x, 2 / a),
        (x ** Fraction(1, 2), a**0.5),
        (x ** -2, a**-2),
        (-0.5 * x, -0.5 * a),
        (x * Fraction(-1, 3), -a / 3),
        (x * "x + y", a * (a + b)),
        ("x + y" * x, (a + b) * a),
        (1e-7 * x + 1e22, 1e-7 * a + 1e22),
        (abs(-x), a),
        (an.piecewise((x > 3, 1), (x >= 3, 2), 3), 2),
        (an.minimum(x, y) + an.maximum(x, y), a + b),
        (an.norm([x, y, 0]), 34**0.5),
        (an.rotz(an.pi / 2)(1, 2, 3) @ ex, -2),
        (an.dot(an.cross(ex, ey), ez), 1),
        ((x * y).dt, 10),
        (x.dt, 2),
    ):
        assert number(ours) == pytest.approx(theirs, rel=1e-15), repr(ours)


def test_conditions_and_equations_in_the_place_of_formulas_are_named() -> None:
    b, x, y = bead()
    with pytest.raises(TypeError, match="'x > 1' is a condition, and a formula is expected here: the difference of the sides"):
        b.event("e", x > 1, stop=True)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"conditions=\[x.dt == y\]"):
        b.initial({x.dt == y})  # type: ignore[arg-type]


def test_fractions_to_the_left_of_a_power_stay_exact() -> None:
    _, x, _ = bead()
    assert (Fraction(1, 3) ** x).text == "(1/3)^x" and (Fraction(-2, 7) ** (x + 1)).text == "(-2/7)^(x + 1)"
    assert (0.1**x).text == "0.1^x" and (2**x).text == "2^x"


def test_sides_of_equations_stay_where_they_are() -> None:
    b, x, y = bead()
    place, frame = b.point("P", [x, 0, 0]), b.frame("F", an.rotz(y))
    assert (x * ex == place).text == "x*ex = P" and (place == x * ex).text == "P = x*ex"
    nothing: Any = 0
    assert (nothing == x).text == "x = 0" and (x == nothing).text == "x = 0"
    assert frame(1, x, 0).text == "F(1, x, 0)" and (frame * an.rotx(x)).x.text == "(F*rotx(x)).x"


def test_springs() -> None:
    def made(by_spring: bool) -> an.Model:
        b = an.Builder("two")
        x, y = b.coordinates("x y")
        k, c = b.parameters(k=4, c=0.25)
        p, q = b.particle("p", mass=1, position=x * ex), b.particle("q", mass=2, position=y * ex + ey)
        wall = b.point("wall", "-3*ex")
        if by_spring:
            b.spring(p, q, stiffness=k, length=0.5, damping=c)
            b.spring(p, wall, stiffness=2)
        else:
            b.force(p, from_=q, tension="k*(norm(p - q) - 0.5) + c*D(norm(p - q), 1)")
            b.force(p, "2*norm(p - wall)*unit(wall - p)")
        b.initial({x: 0, y: 2, x.dt: 0.1, y.dt: 0})
        return b.model()

    one, other = made(True).simulate(to=2), made(False).simulate(to=2)
    assert all(one[name].tobytes() == other[name].tobytes() for name in one)
    h = one["x"] * 0
    assert h.shape == one.t.shape


def test_expressions_go_to_sympy() -> None:
    sm = pytest.importorskip("sympy")
    from sympy.physics.mechanics import dynamicsymbols

    b = an.Builder("a bead")
    x = b.coordinate("x")
    (m,) = b.parameters(m=0.1)
    e = sm.sympify(m / 2 * x.dt**2 + 0.3 * an.cos(x))
    s = dynamicsymbols("x")
    assert e == sm.Symbol("m") / 2 * s.diff(dynamicsymbols._t) ** 2 + sm.Rational(3, 10) * sm.cos(s)
    assert sm.sympify(x == m) == sm.Eq(s, sm.Symbol("m"))
    with pytest.raises((TypeError, sm.SympifyError)):
        sm.sympify(x * ex)
    speed, rate = b.define("speed", x.dt**2), b.quasi("rate", 2 * x.dt)
    assert sm.sympify(speed / 2) == s.diff() ** 2 / 2 and sm.sympify((speed * x).dt) == sm.sympify((x.dt**2 * x).dt)
    assert sm.sympify(rate.dt) == 2 * s.diff().diff() and (speed.dt.text, rate.dt.text) == ("speed'", "rate'")
    for vector in (b.define("place", x * ex), b.define("text", "x*ex")):
        with pytest.raises((TypeError, sm.SympifyError)):
            sm.sympify(vector)


def test_numpy_leaves_products_to_expressions() -> None:
    import numpy as np

    x = an.expr("x")
    assert (np.float64(0.1) * x).text == "0.1*x" and (np.int64(2) + x).text == "2 + x"
    assert an.expr(np.array([1.0, 0.5, 0.0])).text == "1.0*ex + 0.5*ey + 0.0*ez"


def test_lines_that_messages_name_are_those_of_python() -> None:
    b = an.Builder("t")
    x, y = b.coordinates("x y")
    twice = _line()
    b.coordinate("y")
    b.particle("p", mass="mm", position=x * ex)
    b.particle("q", mass="mm", position=y * ex)
    b.body("q", mass=1, center=x * ex)
    with pytest.raises(an.ModelError) as told:
        b.model()
    text = str(told.value)
    assert f"{__file__}:{twice + 1}: error: 'y' is already declared in line {twice - 1}\n" in text
    assert f"{__file__}:{twice + 4}: error: a body 'q' is already declared in line {twice + 3}\n" in text
    assert f"{__file__}:{twice + 2}: error: unknown name 'mm'\n" in text and f"; it stands in line {twice + 3}, too" in text


def test_lines_of_an_inconsistent_start_are_those_of_python() -> None:
    b = an.Builder("t")
    x, y = b.coordinates("x y")
    b.particle("p", mass=1, position=x * ex + y * ey)
    at = _line()
    b.constraint("ring", x**2 + y**2 == 1)
    b.initial({x: 2})
    with pytest.raises(an.MotionError) as told:
        b.model(check=True)
    assert f"x = 2 ({__file__}:{at + 2}) clashes with constraint 'ring' ({__file__}:{at + 1})" in str(told.value)


def test_lines_without_a_line_of_python_and_lines_of_other_files() -> None:
    b = an.Builder("t")
    b.coordinate("x")
    told = b._file.with_lines_of_python
    assert told("see line 1, and line 12 of base.toml, line 3 of 'u.csv', line 2, column 4 of 'u.csv', line 99") == (
        "see line 1 of Builder.text, and line 12 of base.toml, line 3 of 'u.csv', line 2, column 4 of 'u.csv', line 99 of Builder.text"
    )


def test_a_name_of_another_builder() -> None:
    a = an.Builder("the other")
    w = a.coordinate("w")
    k = a.parameter("spring", 2)
    b = an.Builder("t")
    x = b.coordinate("x")
    b.particle("p", mass=1, position=x * ex + w * ey)
    b.force("p", -k * x * ex)
    with pytest.raises(an.ModelError) as told:
        b.model()
    for name in ("w", "spring"):
        assert f"hint: another builder, 'the other', has {name}; formulas hold names of their own builder" in str(told.value)


def test_a_builder_runs_as_a_script(tmp_path: pathlib.Path) -> None:
    script = tmp_path / "mine.py"
    script.write_text("import anholon as an\nb = an.Builder('m')\nx = b.coordinate('x')\nb.particle('p', mass='mm', position=x*an.ex)\nb.model()\n")
    import sys

    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False)
    assert f"{script}:4: error: unknown name 'mm'" in done.stderr


def test_contacts() -> None:
    b = an.Builder("Ball on a floor")
    x, z = b.coordinates("x z")
    P = b.point("P", x * ex + z * ez)
    ball = b.particle("ball", mass=1, position=P)
    floor = b.contact("floor", gap=z, slip=P.vel(), along=[ex], friction="0.25", static_friction="0.5", restitution="0.5", impact="poisson")
    b.contact("wall", body=ball, normal=-ex, through=ex, impact="poisson")
    b.gravity(-10 * ez)
    b.monitor("load", floor.multiplier)
    b.initial({z: "0.2", x.dt: "0.1"})
    model = b.model()
    assert [e.name for e in model.simulate(to=1).events][:1] == ["floor.hits"]
    first = model.sweep({"z": ["0.2", "0.45"]}, to=1, reduce=["first(floor.hits)", "count(wall.hits)", "max(x')"])
    assert first["first(floor.hits)"] == pytest.approx([0.2, 0.3], abs=1e-14)
    assert list(first["count(wall.hits)"]) == [0, 0]
    assert list(first["max(x')"]) == [0.1, 0.1]
    with pytest.raises(an.ModelError, match="did you mean 'floor.hits'"):
        model.sweep({"z": ["0.2"]}, to=1, reduce=["count(floor.hit)"])


def test_constraints_that_are_switched_or_push() -> None:
    b = an.Builder("Ball on a string")
    x, y = b.coordinates("x y")
    b.particle("ball", mass=1, position=x * ex + y * ey)
    taut = b.mode("taut", 0)
    b.constraint("string", x**2 + y**2 == 1, active=taut)
    b.event("tightens", x**2 + y**2 - 1, direction="up", set={taut: 1})
    b.gravity(-10 * ey)
    b.initial({x: "0.6"})
    assert [e.name for e in b.model().simulate(to=1).events] == ["tightens"]  # where y = -0.8
    assert b.model().simulate(to=1).events[0].t == pytest.approx(0.4, abs=1e-14)
    c = an.Builder("Bead that lies on a table")
    (z,) = c.coordinates("z")
    c.particle("bead", mass=2, position=z * ez)
    table = c.constraint("table", z == 0, one_sided=True)
    c.gravity(-10 * ez)
    c.monitor("load", table.multiplier)
    assert c.model().simulate(at=[1])["load"] == pytest.approx([20])


def test_a_table_may_stand_in_a_file(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "push.csv").write_text("t,none,push\n0,0,1\n2,0,3\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)

    def pushed(**table: Any) -> an.Run:
        b = an.Builder("Cart")
        x = b.coordinate("x")
        b.table("push", **table)
        b.particle("cart", mass=1, position=[x, 0, 0])
        b.force("cart", [an.call("push", an.t), 0, 0])
        return b.model().simulate(at=[0, 1, 2])

    written = pushed(x=[0, 2], y=[1, 3])
    assert written["x"][-1] == pytest.approx(2 + 4 / 3, abs=1e-12)
    for columns in (["t", "push"], [1, 3]):
        assert np.array_equal(pushed(file=tmp_path / "push.csv", columns=columns)["x"], written["x"])
        assert np.array_equal(pushed(file="push.csv", columns=columns)["x"], written["x"])
    with pytest.raises(an.ModelError, match="relative to the working directory"):
        pushed(file="pull.csv")
