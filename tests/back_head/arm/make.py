"""The mesh and the reference numbers in this folder: half an arm of tetrahedra with curved edges, meshed
by Gmsh; its frequencies, mass and the gauge's reading of every mode by scikit-fem, an independent finite
element program: with four integration points for the stiffness, as the reduction has them, and with
enough for the curved edges too.

    pip install gmsh==4.15.2 scikit-fem==12.0.2 meshio==5.3.5 scipy && python make.py
"""
import json
import math

import gmsh
import meshio
import numpy as np
import scipy.optimize
import scipy.sparse.linalg as sla
import skfem
from skfem import Basis, ElementTetP2, ElementVector, MeshTet2, asm
from skfem.models.elasticity import lame_parameters, linear_elasticity
from skfem.helpers import dot

E, NU, RHO = 206.0e9, 0.3, 7850.0
GAUGE, LENGTH = (-0.46, 0.03, 0.04), 0.02
STATIONS_DEG = (141.0, 163.0, 180.0, 205.0)


def mesh():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    occ = gmsh.model.occ
    # a ring between radii 0.35 and 0.6 m, of which the sector from 135 to 215 deg stays
    angle = math.radians(80)
    outer = occ.addCylinder(0, 0, 0, 0, 0, 0.05, 0.6, angle=angle)
    inner = occ.addCylinder(0, 0, 0, 0, 0, 0.05, 0.35, angle=angle)
    body, _ = occ.cut([(3, outer)], [(3, inner)])
    occ.rotate(body, 0, 0, 0, 0, 0, 1, math.radians(135))
    place = lambda radius, deg: (radius * math.cos(math.radians(deg)), radius * math.sin(math.radians(deg)))
    pins = []
    for deg in (150, 200):
        x, y = place(0.43, deg)
        pins.append((3, occ.addCylinder(x, y, 0, 0, 0, 0.05, 0.04)))
    body, _ = occ.cut(body, pins)
    occ.synchronize()
    groups = {"symmetry": [], "rope_surface": [], "pin_a": [], "pin_b": []}
    for dim, tag in gmsh.model.getEntities(2):
        x, y, z = occ.getCenterOfMass(dim, tag)
        box = gmsh.model.getBoundingBox(dim, tag)
        if abs(box[5]) < 1e-5:
            groups["symmetry"].append(tag)
        elif gmsh.model.getType(dim, tag) == "Cylinder":
            radius = math.hypot(x, y)
            for name, deg in (("pin_a", 150), ("pin_b", 200)):
                px, py = place(0.43, deg)
                if math.hypot(x - px, y - py) < 1e-3:
                    groups[name].append(tag)
            if radius > 0.5:
                groups["rope_surface"].append(tag)
    for name, tags in groups.items():
        assert tags, name
        gmsh.model.addPhysicalGroup(2, tags, name=name)
    gmsh.model.addPhysicalGroup(3, [body[0][1]], name="steel")
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.09)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.055)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.write("arm.msh")
    gmsh.finalize()


def shape(l):
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    return np.array([x * (2 * x - 1) for x in l] + [4 * l[a] * l[b] for a, b in edges])


def read_at(points, tets, values, place):
    """Displacement at a place: the element whose volume coordinates there are all positive."""
    for nodes in tets:
        x = points[nodes]
        if np.linalg.norm(place - x[:4].mean(axis=0)) > 0.2:
            continue
        fit = scipy.optimize.root(
            lambda r: shape([1 - r.sum(), *r]) @ x - place, np.full(3, 0.25), tol=1e-13)
        if np.abs(fit.fun).max() < 1e-11 and min([1 - fit.x.sum(), *fit.x]) > -1e-9:
            at = [values[tuple(np.round(p, 9))] for p in x]
            return shape([1 - fit.x.sum(), *fit.x]) @ np.array(at)
    raise ValueError("the gauge is not on the steel")


def line(points, rim, psi):
    """Shares of nodes in the mean over the line of constant angle, by Gauss points along its height."""
    shares = {}
    edges = [(0, 1), (1, 2), (2, 0)]
    for at, weight in zip(*np.polynomial.legendre.leggauss(24)):
        z = 0.025 * (1 + at)
        for face in rim:
            x = points[face]

            def functions(l):
                l = [1 - l.sum(), *l]
                return np.array([v * (2 * v - 1) for v in l] + [4 * l[a] * l[b] for a, b in edges])

            def beside(l):
                here = functions(l) @ x
                return [math.cos(psi) * here[1] - math.sin(psi) * here[0], here[2] - z]

            if abs(beside(np.full(2, 1 / 3))[0]) > 0.1:
                continue
            fit = scipy.optimize.root(beside, np.full(2, 1 / 3), tol=1e-13)
            if np.abs(fit.fun).max() < 1e-11 and min([1 - fit.x.sum(), *fit.x]) > -1e-9:
                for node, share in zip(face, functions(fit.x)):
                    shares[node] = shares.get(node, 0.0) + 0.5 * weight * share
                break
        else:
            raise ValueError("the rope surface has a gap")
    return shares


def reference(order):
    """Modes of both families of the whole arm, from its half; `order` of integration of the stiffness."""
    read = meshio.read("arm.msh")
    tets = read.cells_dict["tetra10"]          # in VTK's order
    held, rim = set(), []
    for block, data in zip(read.cells, read.cell_data["gmsh:physical"]):
        if block.type == "triangle6":
            names = {int(v[0]): k for k, v in read.field_data.items() if v[1] == 2}
            for face, tag in zip(block.data, data):
                if names[int(tag)].startswith("pin"):
                    held.update(int(n) for n in face)
                if names[int(tag)] == "rope_surface":
                    rim.append(face)
    # a mesh of curved elements, numbered as the quadratic functions on straight ones are
    linear = skfem.MeshTet(read.points[np.unique(tets[:, :4])].T,
                           np.searchsorted(np.unique(tets[:, :4]), tets[:, :4]).T)
    scalar = Basis(linear, ElementTetP2())
    # each edge's degree of freedom stands at the middle of its straight edge
    corners = np.unique(tets[:, :4])
    edge = {}
    for t in tets:
        for k, (a, b) in enumerate([(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]):
            edge[tuple(sorted((t[a], t[b])))] = t[4 + k]
    nodes = np.zeros(scalar.N, dtype=int)
    nodes[scalar.nodal_dofs[0]] = corners
    for e, (a, b) in enumerate(linear.edges.T):
        nodes[scalar.edge_dofs[0][e]] = edge[tuple(sorted((corners[a], corners[b])))]
    m = MeshTet2(read.points[nodes].T, linear.t)
    basis = Basis(m, ElementVector(ElementTetP2()), intorder=order)
    K = asm(linear_elasticity(*lame_parameters(E, NU)), basis)
    massbasis = Basis(m, ElementVector(ElementTetP2()), intorder=8)

    @skfem.BilinearForm
    def weigh(u, v, _):
        return RHO * dot(u, v)

    M = asm(weigh, massbasis)
    locations = basis.doflocs.T
    # vector degrees of freedom: component by name order
    component = np.zeros(basis.N, dtype=int)
    for dofs in (basis.nodal_dofs, basis.edge_dofs):
        for c in range(3):
            component[dofs[c]] = c
    number = {(tuple(np.round(p, 9)), component[d]): d for d, p in enumerate(locations)}
    held_places = {tuple(np.round(read.points[n], 9)) for n in held}
    is_held = np.array([tuple(np.round(p, 9)) in held_places for p in locations])
    assert is_held.sum() == 3 * len(held), (is_held.sum(), len(held))
    plane = np.abs(locations[:, 2]) < 1e-9
    ones = (component == 0).astype(float)
    result = {"mass_kg": 2.0 * float(ones @ (M @ ones))}
    ends = np.array([[GAUGE[0], GAUGE[1] + s * LENGTH / 2, GAUGE[2]] for s in (1, -1)]).T
    for family, out in (("symmetric", (2,)), ("antisymmetric", (0, 1))):
        free = ~is_held & ~(plane & np.isin(component, out))
        index = np.nonzero(free)[0]
        values, shapes = sla.eigsh(K[index][:, index], 4, M[index][:, index], sigma=0, tol=1e-12)
        frequencies = np.sqrt(values) / (2 * np.pi)
        stress = []
        for k in range(4):
            u = np.zeros(basis.N)
            u[index] = shapes[:, k] / math.sqrt(2.0)
            up = {place: u[number[place, 1]] for place, axis in number if axis == 1}
            moved = [read_at(read.points, tets, up, end) for end in ends.T]
            stress.append(abs(E * (moved[0] - moved[1]) / LENGTH))
        if family == "symmetric":
            solve = sla.factorized(K[index][:, index].tocsc())
            result["normal_influence_pa_per_n"] = []
            for deg in STATIONS_DEG:
                psi = math.radians(deg)
                # a newton over the whole width, inwards, is half a newton on the half
                force = np.zeros(basis.N)
                for node, share in line(read.points, rim, psi).items():
                    place = tuple(np.round(read.points[node], 9))
                    for axis, along in enumerate((math.cos(psi), math.sin(psi))):
                        force[number[place, axis]] -= 0.5 * share * along
                u = np.zeros(basis.N)
                u[index] = solve(force[index])
                up = {place: u[number[place, 1]] for place, axis in number if axis == 1}
                moved = [read_at(read.points, tets, up, end) for end in ends.T]
                result["normal_influence_pa_per_n"].append(float(E * (moved[0] - moved[1]) / LENGTH))
        result[family] = {"frequencies_hz": list(map(float, frequencies)), "gauge_stress_pa": list(map(float, stress))}
    return result


if __name__ == "__main__":
    mesh()
    numbers = {"four_points": reference(2), "exact": reference(8)}
    with open("reference.json", "w") as to:
        json.dump(numbers, to, indent=1)
        to.write("\n")
