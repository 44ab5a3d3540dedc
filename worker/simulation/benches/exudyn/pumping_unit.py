"""The same class of machine in Exudyn, for its price: one revolution, planar.

    python3 -m venv exudyn && exudyn/bin/pip install "exudyn==1.13.*"
    exudyn/bin/python worker/simulation/benches/exudyn/pumping_unit.py cases/cyjs10-5-37hb --step 1e-3

What is the same: geometry, masses, load card, speed, 72 + 114 cylinders of 50 mm with their inertia,
the six-component bushings between them (planar: three components) with half-pitch end joints, Hertz
exponent and stiffness of the contact with both arcs, gravity, the crank's start.

What differs: both heads are rigid (no modes, hence no gauges: only the work is compared); contact acts at
one point of a cylinder instead of three and with its damping at once instead of ramped in; Exudyn's
bushing is its own (force in one marker's frame, see its documentation of
ConnectorRigidBodySpringDamper); bodies have three coordinates, with the crank, rod, beam and suspension
joined by constraints; the rope is laid out unstretched and loaded within a second instead of starting
from equilibrium, which is timed apart.

Steps are fixed: generalised-alpha, modified Newton, the sparse solver, and the compilation of Exudyn without
range checks (exudynFast), the fastest settings found.
"""
import argparse
import csv
import math
import sys
import time
import tomllib
from pathlib import Path

sys.exudynFast = True
import exudyn as exu
from exudyn.itemInterface import (
    LoadCoordinate,
    LoadMassProportional,
    MarkerBodyMass,
    MarkerBodyPosition,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    NodeGenericData,
    NodePointGround,
    NodeRigidBody2D,
    ObjectConnectorCoordinate,
    ObjectConnectorRigidBodySpringDamper,
    ObjectContactSphereSphere,
    ObjectGround,
    ObjectJointRevolute2D,
    ObjectRigidBody2D,
)

DEG = math.pi / 180
SETTLE = 1.0  # time in which the load comes on, crank at rest [s]


def read_case(folder, genes):
    case = tomllib.loads((folder / "case.toml").read_text())
    with open(folder / "machine" / "kinematics_720.csv") as lines:
        rows = [{k: float(x) for k, x in row.items()} for row in csv.DictReader(lines)]
    with open(folder / case["conditions"][0]["card_file"]) as lines:
        card = [
            [float(x) for x in line.split(",")[:2]]
            for line in lines
            if line[0] in "-.0123456789"
        ]
    values = {name: gene["recommended"] for name, gene in case["genes"].items()}
    if genes:
        found = tomllib.loads(Path(genes).read_text())
        values = {name: found[name]["value"] for name in values}
    return case, rows, card, values


def at(center, radius, angle):
    return [center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle)]


def rope_path(center, radius, anchor, leave, sense, pitch, count):
    """Joints from the anchor on: along the arc to where the rope leaves it, then straight."""
    points = []
    wrap = radius * abs(anchor - leave)
    for k in range(count + 1):
        along = k * pitch
        if along < wrap:
            points.append(at(center, radius, anchor - sense * along / radius))
        else:
            x, y = at(center, radius, leave)
            tx, ty = math.sin(leave) * sense, -math.cos(leave) * sense
            points.append([x + tx * (along - wrap), y + ty * (along - wrap)])
    return points


class Machine:
    def __init__(self, folder, genes):
        self.case, self.rows, self.card, self.values = read_case(folder, genes)
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.ground = self.mbs.AddObject(ObjectGround())
        case = self.case
        self.gravity = case["gravity_m_s2"]
        self.speed = case["conditions"][0]["speed_rpm"] * 2 * math.pi / 60
        self.lead = case["run"]["lead_in_deg"]
        self.ramp = case["run"]["ramp_s"]
        start = self.rows[int(round((360 - self.lead) / 0.5))]
        self.start = start
        self.beam_angle = start["beam_deg"] * DEG
        self.mechanism(start)
        self.ropes(start)

    # ---- rigid bodies -------------------------------------------------------------------------
    def body(self, mass, inertia, x, y, angle):
        node = self.mbs.AddNode(NodeRigidBody2D(referenceCoordinates=[x, y, angle]))
        body = self.mbs.AddObject(
            ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node)
        )
        marker = self.mbs.AddMarker(MarkerBodyMass(bodyNumber=body))
        self.mbs.AddLoad(
            LoadMassProportional(markerNumber=marker, loadVector=[0, -self.gravity, 0])
        )
        return node, body

    def position(self, body, x, y):
        return self.mbs.AddMarker(
            MarkerBodyPosition(bodyNumber=body, localPosition=[x, y, 0])
        )

    def rigid(self, body, x, y):
        return self.mbs.AddMarker(
            MarkerBodyRigid(bodyNumber=body, localPosition=[x, y, 0])
        )

    def pin(self, first, second):
        self.mbs.AddObject(ObjectJointRevolute2D(markerNumbers=[first, second]))

    def turn(self, t):
        """Crank angle from its start [rad], positive."""
        s = (t - SETTLE) / self.ramp
        if s <= 0:
            return 0.0
        if s < 1:
            return self.speed * self.ramp * (s**3 - s**4 / 2)
        return self.speed * (t - SETTLE - self.ramp / 2)

    def end_time(self):
        return SETTLE + self.ramp / 2 + (360 + self.lead) * DEG / self.speed

    def load(self, t):
        turn = (self.turn(t) / DEG - self.lead) % 360
        place = turn / 360 * len(self.card)
        k = int(place)
        low, high = self.card[k % len(self.card)], self.card[(k + 1) % len(self.card)]
        return low[1] + (place - k) * (high[1] - low[1])

    def mechanism(self, start):
        mbs, case = self.mbs, self.case
        crank, rod, beam = case["crank"], case["rod"], case["beam"]
        center = [crank["center_x_m"], crank["center_y_m"]]
        angle = start["crank_pin_ccw_from_x_deg"] * DEG
        pin = at(center, crank["radius_m"], angle)
        node, body = self.body(1.0, 1.0, *center, angle)
        self.pin(
            self.position(self.ground, *center), self.position(body, 0, 0)
        )
        fixed = mbs.AddNode(NodePointGround(referenceCoordinates=[0, 0, 0]))
        mbs.AddObject(
            ObjectConnectorCoordinate(
                markerNumbers=[
                    mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0)),
                    mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=2)),
                ],
                # the crank turns clockwise
                offsetUserFunction=lambda mbs, t, item, offset: -self.turn(t),
            )
        )
        crank_pin = self.position(body, crank["radius_m"], 0)

        # the rod points along the straight rope, towards the head
        leave = start["Psi_deg"] * DEG
        arc = case["back_head"]
        c, s = math.cos(self.beam_angle), math.sin(self.beam_angle)
        x, y = arc["center_x_m"], arc["center_y_m"]
        self.back_center = [c * x - s * y, s * x + c * y]
        touch = at(self.back_center, arc["radius_m"], leave)
        rod_angle = math.atan2(touch[1] - pin[1], touch[0] - pin[0])
        g = at(pin, rod["center_of_mass_m"], rod_angle)
        _, body = self.body(rod["mass_kg"], rod["inertia_kg_m2"], *g, rod_angle)
        self.pin(crank_pin, self.position(body, -rod["center_of_mass_m"], 0))
        self.crossbeam = self.rigid(body, rod["length_m"] - rod["center_of_mass_m"], 0)

        _, self.beam = self.body(1.0, beam["inertia_kg_m2"], 0, 0, self.beam_angle)
        self.pin(self.position(self.ground, 0, 0), self.position(self.beam, 0, 0))

    # ---- ropes --------------------------------------------------------------------------------
    def bushing(self, first, second, scale, turns=True):
        v = self.values
        k = [scale * v["kb1"], scale * v["kb23"]]
        c = [scale * v["cb1"], scale * v["cb23"]]
        turning = scale / DEG if turns else 0.0
        k6, c6 = turning * v["kb56"], turning * v["cb56"]
        if not turns:
            k[1], c[1] = k[0], c[0]
        stiffness, damping = ([[0.0] * 6 for _ in range(6)] for _ in range(2))
        for i, (ki, ci) in enumerate(zip([k[0], k[1], 0, 0, 0, k6], [c[0], c[1], 0, 0, 0, c6])):
            stiffness[i][i], damping[i][i] = ki, ci
        self.mbs.AddObject(
            ObjectConnectorRigidBodySpringDamper(
                markerNumbers=[first, second], stiffness=stiffness, damping=damping
            )
        )

    def contact(self, cylinder, drum, radius, thickness):
        data = self.mbs.AddNode(
            NodeGenericData(numberOfDataCoordinates=4, initialCoordinates=[0.1, 0, 0, 0])
        )
        self.mbs.AddObject(
            ObjectContactSphereSphere(
                markerNumbers=[cylinder, drum],
                nodeNumber=data,
                spheresRadii=[thickness, radius - thickness],
                contactStiffness=self.values["kc"],
                contactStiffnessExponent=self.case["contact"]["exponent"],
                contactDamping=self.values["cc"],
            )
        )

    def rope(self, joints, drum, radius, anchor, free_end):
        """Cylinders between joints, from the anchor on."""
        rope = self.case["ropes"]
        pitch, diameter = rope["cylinder_length_m"], rope["diameter_m"]
        mass = rope["density_kg_m3"] * math.pi / 4 * diameter**2 * pitch
        inertia = mass * (3 * (diameter / 2) ** 2 + pitch**2) / 12
        before = anchor
        for k, (a, b) in enumerate(zip(joints, joints[1:])):
            angle = math.atan2(b[1] - a[1], b[0] - a[0])
            _, body = self.body(mass, inertia, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, angle)
            # an end joint stands for half a pitch
            self.bushing(before, self.rigid(body, -pitch / 2, 0), 2.0 if k == 0 else 1.0)
            self.contact(self.rigid(body, 0, 0), drum, radius, diameter / 2)
            before = self.rigid(body, pitch / 2, 0)
        self.bushing(before, free_end, 2.0, turns=False)

    def ropes(self, start):
        case = self.case
        pitch = case["ropes"]["cylinder_length_m"]
        back, front = case["back_head"], case["front_head"]
        center = [back["center_x_m"], back["center_y_m"]]
        joints = rope_path(
            self.back_center,
            back["radius_m"],
            back["rope_anchor_deg"] * DEG + self.beam_angle,
            start["Psi_deg"] * DEG,
            -1.0,
            pitch,
            case["ropes"]["back_cylinders"],
        )
        drum = self.rigid(self.beam, *center)
        self.rope(joints, drum, back["radius_m"], self.head(joints), self.crossbeam)

        joints = rope_path(
            [0, 0],
            front["radius_m"],
            front["rope_anchor_deg"] * DEG + self.beam_angle,
            0.0,
            1.0,
            pitch,
            case["ropes"]["front_cylinders"],
        )
        self.suspension(joints)
        drum = self.rigid(self.beam, 0, 0)
        self.rope(joints, drum, front["radius_m"], self.head(joints), self.hook)

    def head(self, joints):
        """The clamp: a frame on the beam along the first cylinder."""
        (ax, ay), (bx, by) = joints[0], joints[1]
        c, s = math.cos(-self.beam_angle), math.sin(-self.beam_angle)
        turn = math.atan2(by - ay, bx - ax) - self.beam_angle
        frame = [
            [math.cos(turn), -math.sin(turn), 0, c * ax - s * ay],
            [math.sin(turn), math.cos(turn), 0, s * ax + c * ay],
            [0, 0, 1, 0],
            [0, 0, 0, 1],
        ]
        return self.mbs.AddMarker(MarkerBodyRigid(bodyNumber=self.beam, localHT=frame))

    def suspension(self, joints):
        mbs = self.mbs
        x, y = joints[-1]
        mass = self.case["suspension"]["mass_kg"]
        node, body = self.body(mass, 1.0, x, y, 0.0)
        fixed = mbs.AddNode(NodePointGround(referenceCoordinates=[0, 0, 0]))
        for coordinate in (0, 2):
            mbs.AddObject(
                ObjectConnectorCoordinate(
                    markerNumbers=[
                        mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0)),
                        mbs.AddMarker(
                            MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate)
                        ),
                    ]
                )
            )

        def pull(mbs, t, load):
            return -self.load(t) * min(1.0, t / SETTLE)

        mbs.AddLoad(
            LoadCoordinate(
                markerNumber=mbs.AddMarker(
                    MarkerNodeCoordinate(nodeNumber=node, coordinate=1)
                ),
                load=0,
                loadUserFunction=pull,
            )
        )
        self.hook = self.rigid(body, 0, 0)
        self.node = node

    # ---- run ----------------------------------------------------------------------------------
    def run(self, step, full):
        """Processor times of the settling and of the motion [s], and the suspension's way [m]."""
        self.mbs.Assemble()
        end = self.end_time()
        spent = [self.stretch(a, b, step, full) for a, b in ((0.0, SETTLE), (SETTLE, end))]
        coordinates = self.mbs.GetNodeOutput(self.node, exu.OutputVariableType.Coordinates)
        return spent, coordinates[1]

    def stretch(self, begin, end, step, full):
        settings = exu.SimulationSettings()
        time_settings = settings.timeIntegration
        time_settings.startTime = begin
        time_settings.endTime = end
        time_settings.numberOfSteps = int(math.ceil((end - begin) / step))
        time_settings.verboseMode = 0
        time_settings.generalizedAlpha.spectralRadius = 0.5
        # the rope is not in equilibrium at first
        time_settings.generalizedAlpha.computeInitialAccelerations = False
        time_settings.newton.useModifiedNewton = not full
        time_settings.newton.relativeTolerance = 1e-6
        time_settings.newton.absoluteTolerance = 1e-6
        time_settings.newton.maxIterations = 40
        time_settings.newton.modifiedNewtonContractivity = 0.3
        # a contact that opens or closes does not cut the step: some 230 do so in a revolution
        time_settings.discontinuous.useRecommendedStepSize = False
        time_settings.discontinuous.maxIterations = 3
        time_settings.discontinuous.iterationTolerance = 1e3
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        settings.solution.file.write = False
        settings.parallel.numberOfThreads = 1
        # of one thread, so that a busy machine counts less
        begun = time.process_time()
        self.mbs.SolveDynamic(settings, updateInitialValues=True)
        spent = time.process_time() - begun
        if self.mbs.systemData.GetTime() < end - step:
            sys.exit("the run ended early")
        return spent


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("case", type=Path)
    parser.add_argument("--genes", help="gene file, such as table3_optimised.toml")
    parser.add_argument("--step", type=float, default=1e-3, help="step [s]")
    parser.add_argument("--full-newton", action="store_true")
    options = parser.parse_args()
    machine = Machine(options.case, options.genes)
    (settling, moving), way = machine.run(options.step, options.full_newton)
    whole = machine.end_time() - SETTLE
    print(f"exudyn {exu.config.Version() if hasattr(exu, 'config') else exu.GetVersionString()}")
    print(f"settling {SETTLE} s: {settling:.1f} s of processor time")
    print(f"start and one revolution, {whole:.2f} s: {moving:.1f} s of processor time")
    print(f"the suspension ends {way:.4f} m above its start")


if __name__ == "__main__":
    main()
