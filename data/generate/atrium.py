"""atrium.glb: a two-storey colonnaded court, lit by a low sun and, in its shade, by nothing but one bounce of it.

The court is BAYS_X by BAYS_Z bays about the origin, long side along z. The sun comes over the -x side, whose arcade
lies in the shade; it lights the court's +x half, the +z end, and the floor of the +x arcade, where the hero camera
stands.
"""

import numpy as np

import atrium_parts as parts
import atrium_shell as shell
import furnishings
import gltf
import textures
from atrium_plan import (
    BAY,
    COURT_LEVEL,
    STEP,
    SPRINGING,
    HALF_WALL,
    VAULT_RISE,
    UPPER_FLOOR,
    UPPER_SPRINGING,
    CEILING,
    RAIL,
    EAVES_OUT,
    OUTER,
)
from mesh import box, quad

BAYS_X, BAYS_Z = 4, 7
HALF_X, HALF_Z = BAYS_X * BAY / 2, BAYS_Z * BAY / 2
# (name, turn about y, centre of the side, bays, half length): each side's +z looks into the court.
SIDES = (
    ("near", np.pi / 2, (-HALF_X, 0.0, 0.0), BAYS_Z, HALF_Z),
    ("far", -np.pi / 2, (HALF_X, 0.0, 0.0), BAYS_Z, HALF_Z),
    ("south", 0.0, (0.0, 0.0, -HALF_Z), BAYS_X, HALF_X),
    ("north", np.pi, (0.0, 0.0, HALF_Z), BAYS_X, HALF_X),
)

SUN_LUX = 90000.0
SUN_COLOR = (1.0, 0.92, 0.80)
SUN_AZIMUTH, SUN_ELEVATION = np.radians(36.0), np.radians(42.0)  # azimuth: from +x towards +z, where the light goes

CLOTH_COLORS = {
    "crimson": (0.50, 0.035, 0.03),
    "forest": (0.045, 0.26, 0.075),
    "azure": (0.035, 0.13, 0.46),
    "ochre": (0.66, 0.34, 0.045),
}


def sun_direction():
    """The direction in which sunlight travels."""
    flat = np.cos(SUN_ELEVATION)
    return np.array([flat * np.cos(SUN_AZIMUTH), -np.sin(SUN_ELEVATION), flat * np.sin(SUN_AZIMUTH)])


class Atrium:
    """The scene under construction: names materials, keeps meshes, places parts in the frames of the sides."""

    def __init__(self):
        self.glb = gltf.Glb("atrium", "Earthshine authors")
        self.materials = {}
        self.meshes = {}
        self._add_materials()

    def _textured(self, name, tile, pictures, color=(1.0, 1.0, 1.0), double_sided=False):
        glb = self.glb
        infos = [
            glb.texture_info(
                glb.add_texture(glb.add_image(f"{name}.{role}", textures.jpeg(picture), "image/jpeg")), (tile, tile)
            )
            for role, picture in zip(("color", "normal"), pictures)
        ]
        self.materials[name] = glb.add_material(
            name, color, infos[0], infos[1] if len(infos) > 1 else None, double_sided
        )
        return infos

    def _add_materials(self):
        glb = self.glb
        self._textured("stone", 1.2, textures.limestone())
        self._textured("ashlar", 2.4, textures.ashlar())
        self._textured("plaster", 3.2, textures.plaster())
        self._textured("court_paving", BAY, textures.court_paving())
        self._textured("arcade_tiles", 1.6, textures.arcade_tiles())
        self._textured("terracotta", 1.0, textures.terracotta())
        self._textured("wood", 1.0, textures.wood())
        plaster = glb.json["materials"][self.materials["plaster"]]
        self.materials["dado"] = glb.add_material(
            "dado", (0.62, 0.33, 0.22), plaster["pbrMetallicRoughness"]["baseColorTexture"], plaster["normalTexture"]
        )
        weave = glb.texture_info(
            glb.add_texture(glb.add_image("cloth", textures.jpeg(textures.cloth()), "image/jpeg")), (0.5, 0.5)
        )
        for name, color in CLOTH_COLORS.items():
            self.materials[name] = glb.add_material(name, color, weave, double_sided=True)
        leaf = glb.texture_info(glb.add_texture(glb.add_image("leaves", textures.png(textures.leaves()), "image/png")))
        self.materials["leaves"] = glb.add_material("leaves", (1, 1, 1), leaf, double_sided=True, alpha_cutoff=0.5)
        for name, color in (
            ("glaze", (0.05, 0.12, 0.34)),
            ("iron", (0.035, 0.032, 0.03)),
            ("earth", (0.09, 0.06, 0.04)),
            ("bark", (0.16, 0.11, 0.07)),
            ("fruit", (0.75, 0.30, 0.02)),
            ("water", (0.05, 0.13, 0.14)),
            ("milk_glass", (0.75, 0.70, 0.58)),
        ):
            self.materials[name] = glb.add_material(name, color)

    def mesh(self, name, build):
        """The index of the mesh of that name, built on first use from {material: Mesh}."""
        if name not in self.meshes:
            self.meshes[name] = self.glb.add_mesh(
                name, [(shape, self.materials[material]) for material, shape in build().items()]
            )
        return self.meshes[name]

    def place(self, name, mesh, side, x, y=0.0, z=0.0, turn=0.0, scale=None):
        """Puts a mesh at (x, y, z) of a side's frame, turned about y."""
        _, side_turn, origin, _, _ = side
        c, s = np.cos(side_turn), np.sin(side_turn)
        self.glb.add_node(
            name,
            mesh=mesh,
            rotation=gltf.turn_y(side_turn + turn),
            scale=scale,
            translation=(origin[0] + c * x + s * z, origin[1] + y, origin[2] - s * x + c * z),
        )

    def cloth(self, shape, color, build):
        """A mesh of cloth in one of the colours; all colours of a shape share its vertices."""
        key = f"{shape}.{color}"
        if shape not in self.meshes:
            self.meshes[shape] = build()
        return self.mesh(key, lambda: {color: self.meshes[shape]})


def add_architecture(a):
    """The building itself."""
    a.glb.add_node("shell", mesh=a.mesh("shell", lambda: shell.shell(HALF_X, HALF_Z)))
    a.glb.add_node("cornice", mesh=a.mesh("cornice", lambda: shell.cornice(HALF_X, HALF_Z)))
    a.place("south_wall", a.mesh("south_wall", lambda: shell.south_wall(HALF_X)), SIDES[2], 0.0)
    reach_x, reach_z = HALF_X - STEP, HALF_Z - STEP
    court = quad(
        (-reach_x, COURT_LEVEL, reach_z),
        (reach_x, COURT_LEVEL, reach_z),
        (reach_x, COURT_LEVEL, -reach_z),
        (-reach_x, COURT_LEVEL, -reach_z),
    )
    court.uvs += (BAY * (BAYS_X % 2) / 2, BAY * (BAYS_Z % 2) / 2)
    a.glb.add_node("court", mesh=a.mesh("court", lambda: {"court_paving": court}))

    lower, upper = a.mesh("lower_bay", parts.lower_bay), a.mesh("upper_bay", parts.upper_bay)
    rib, pedestal = a.mesh("rib", parts.transverse_rib), a.mesh("pedestal", parts.pedestal)
    column = a.mesh("column", lambda: parts.column(SPRINGING, 0.21, 32, (10, 5), flutes=20))
    slender = a.mesh("slender_column", lambda: parts.column(UPPER_SPRINGING - RAIL - 0.01, 0.115, 16, (7, 3)))
    baluster = a.mesh("baluster", parts.baluster)
    roundel = a.mesh("roundel", lambda: parts.roundel(0.25, 3.98, HALF_WALL))
    for side in SIDES:
        name, _, _, bays, half = side
        a.place(f"{name}.beams", a.mesh(f"beams.{bays}", lambda: shell.beams(half, 0.8)), side, 0.0)
        a.place(f"{name}.dentils", a.mesh(f"dentils.{bays}", lambda: shell.dentils(half)), side, 0.0)
        for k in range(bays):
            x = (k + 0.5) * BAY - half
            a.place(f"{name}.lower_bay.{k}", lower, side, x)
            a.place(f"{name}.upper_bay.{k}", upper, side, x)
            for j in range(2):
                for i in range(6):
                    a.place(
                        f"{name}.baluster.{k}.{j}.{i}",
                        baluster,
                        side,
                        x + (j - 0.5) * BAY / 2 + (i - 2.5) * 0.205,
                        UPPER_FLOOR + 0.12,
                    )
        for k in range(bays + 1):
            x = k * BAY - half
            a.place(f"{name}.rib.{k}", rib, side, x)
            if 0 < k < bays:
                a.place(f"{name}.column.{k}", column, side, x)
                a.place(f"{name}.roundel.{k}", roundel, side, x)
        for k in range(1, 2 * bays):
            x = k * BAY / 2 - half
            a.place(f"{name}.pedestal.{k}", pedestal, side, x)
            a.place(f"{name}.slender_column.{k}", slender, side, x, RAIL + 0.01)
    add_corners(a)
    add_roof(a)


def add_corners(a):
    """The four corner piers of both storeys and the vaults behind them."""
    pier = a.mesh("pier", lambda: parts.pier(SPRINGING, 0.30))
    above = a.mesh(
        "corner_wall", lambda: {"ashlar": box((-0.29, SPRINGING, -0.29), (0.29, UPPER_FLOOR, 0.29), "-y +y")}
    )
    upper = a.mesh(
        "upper_pier",
        lambda: {
            "stone": parts.block_stack(
                [
                    (UPPER_FLOOR, UPPER_FLOOR + 0.14, 0.27),
                    (UPPER_FLOOR + 0.14, RAIL - 0.12, 0.24),
                    (RAIL - 0.12, RAIL, 0.27),
                    (RAIL, UPPER_SPRINGING - 0.12, 0.21),
                    (UPPER_SPRINGING - 0.12, UPPER_SPRINGING, 0.26),
                    (UPPER_SPRINGING, CEILING, 0.21),
                ]
            )
        },
    )
    vault = a.mesh("corner_vault", parts.corner_vault)
    for k, (sx, sz, turn) in enumerate(((1, 1, 0.0), (1, -1, np.pi / 2), (-1, -1, np.pi), (-1, 1, -np.pi / 2))):
        position = (sx * HALF_X, 0.0, sz * HALF_Z)
        for name, mesh in (("pier", pier), ("corner_wall", above), ("upper_pier", upper), ("corner_vault", vault)):
            a.glb.add_node(f"{name}.{k}", mesh=mesh, translation=position, rotation=gltf.turn_y(turn))


def add_roof(a):
    """Columns of tiles on the four slopes; towards a valley they get shorter."""
    spacing = 0.26
    run = (EAVES_OUT + OUTER) / shell.TILE_COUNT
    for side in SIDES:
        name, _, _, _, half = side
        eaves = half - EAVES_OUT
        count = int((half + OUTER) / spacing)
        for k in range(-count, count + 1):
            cut = int(np.ceil(max(0.0, abs(k * spacing) - eaves) / run))
            tiles = shell.TILE_COUNT - cut
            if tiles > 0:
                a.place(
                    f"{name}.tiles.{k + count}",
                    a.mesh(f"tiles.{tiles}", lambda: shell.tile_column(tiles)),
                    side,
                    k * spacing,
                )


def add_doors(a):
    door = a.mesh("door", parts.door)
    for side, bays in zip(SIDES, ((1, 3, 5), (4, 2, 0), (1, 2), (1, 2))):
        for k in bays:
            a.place(f"{side[0]}.door.{k}", door, side, (k + 0.5) * BAY - side[4], 0.0, -BAY)
        for k in range(side[3]):
            a.place(
                f"{side[0]}.upper_door.{k}",
                door,
                side,
                (k + 0.5) * BAY - side[4],
                UPPER_FLOOR,
                -BAY,
                scale=(0.85, 0.85, 0.85),
            )


def add_cloth(a):
    """Curtains in the arcades, banners on the balustrades."""
    near, far, south, north = SIDES
    tied = lambda color, seed: a.cloth(
        f"tied_curtain.{seed}", color, lambda: furnishings.curtain(1.05, 2.62, 8, 0.8, seed)
    )
    hanging = lambda color, seed: a.cloth(f"banner.{seed}", color, lambda: furnishings.banner(1.02, 1.95, seed))
    flat = lambda color, seed: a.cloth(f"tapestry.{seed}", color, lambda: furnishings.tapestry(1.9, 2.15, seed))
    rod = a.mesh("curtain_rod", lambda: furnishings.rod(2.56))
    short_rod = a.mesh("tapestry_rod", lambda: furnishings.rod(2.06))
    curtains = [
        (far, 0, "ochre"),
        (far, 2, "azure"),
        (far, 3, "forest"),
        (far, 4, "ochre"),
        (north, 0, "crimson"),
        (north, 1, "ochre"),
        (north, 3, "azure"),
        (near, 1, "crimson"),
        (near, 4, "ochre"),
        (south, 0, "forest"),
        (south, 3, "ochre"),
    ]
    for index, (side, bay, color) in enumerate(curtains):
        x = (bay + 0.5) * BAY - side[4]
        a.place(f"{side[0]}.curtain_rod.{bay}", rod, side, x - 1.28, 2.83)
        a.place(f"{side[0]}.curtain.{bay}.left", tied(color, 1 + index % 3), side, x - 1.25, 2.83)
        a.place(f"{side[0]}.curtain.{bay}.right", tied(color, 1 + (index + 1) % 3), side, x + 1.25, 2.83, turn=np.pi)
    tapestries = [
        (far, 1, "crimson"),
        (far, 3, "azure"),
        (far, 5, "crimson"),
        (near, 0, "crimson"),
        (near, 2, "forest"),
        (near, 4, "azure"),
        (near, 6, "ochre"),
        (north, 0, "forest"),
        (north, 3, "crimson"),
    ]
    for index, (side, bay, color) in enumerate(tapestries):
        x = (bay + 0.5) * BAY - side[4]
        a.place(f"{side[0]}.tapestry_rod.{bay}", short_rod, side, x - 1.03, 2.62, -BAY + 0.08)
        a.place(f"{side[0]}.tapestry.{bay}", flat(color, 1 + index % 2), side, x, 2.62, -BAY)
    order = ("crimson", "ochre", "azure", "forest")
    for side, shift in ((far, 0), (north, 1), (near, 2), (south, 3)):
        for k in range(side[3]):
            x = (k + 0.5) * BAY - side[4]
            for j in range(2):
                if (k + j + shift) % 2 == 0:
                    continue
                color = order[(k * 2 + j + shift) // 2 % 4]
                a.place(
                    f"{side[0]}.banner.{k}.{j}", hanging(color, 1 + (k + j) % 3), side, x + (j - 0.5) * BAY / 2, RAIL
                )


def add_garden(a):
    """The fountain, the plants and the lanterns."""
    a.glb.add_node("fountain", mesh=a.mesh("fountain", furnishings.fountain), translation=(0, COURT_LEVEL + 0.15, 0))
    trees = [a.mesh(f"citrus.{seed}", lambda: furnishings.citrus(seed)) for seed in (3, 4)]
    ferns = [a.mesh(f"fern.{seed}", lambda: furnishings.fern(seed)) for seed in (5, 6)]
    rng = np.random.default_rng(7)
    spots = [(sx * 4.3, sz) for sx in (-1, 1) for sz in (-8.0, -4.8, 4.8, 8.0) if (sx, sz) != (1, 8.0)] + [
        (-2.0, 9.6),
        (2.0, 9.6),
    ]
    for k, (x, z) in enumerate(spots):
        a.glb.add_node(
            f"citrus.{k}", mesh=trees[k % 2], translation=(x, COURT_LEVEL, z), rotation=gltf.turn_y(rng.uniform(0, 6))
        )
    for side in SIDES:
        for k in range(1, side[3]):
            x = k * BAY - side[4]
            a.place(
                f"{side[0]}.fern.{k}",
                ferns[k % 2],
                side,
                x + rng.uniform(-0.05, 0.05),
                0.0,
                -BAY + 0.62,
                turn=rng.uniform(0, 6),
                scale=[rng.uniform(0.85, 1.05)] * 3,
            )
    lantern = a.mesh("lantern", lambda: furnishings.lantern(0.85))
    for side in SIDES:
        for k in range(side[3]):
            a.place(f"{side[0]}.lantern.{k}", lantern, side, (k + 0.5) * BAY - side[4], SPRINGING + VAULT_RISE, -1.725)


def build():
    a = Atrium()
    add_architecture(a)
    add_doors(a)
    add_cloth(a)
    add_garden(a)
    glb = a.glb
    glb.add_node(
        "sun",
        light=glb.add_light("sun", "directional", SUN_LUX, SUN_COLOR),
        translation=(-12.0, 24.0, -12.0),
        rotation=gltf.look_rotation(sun_direction()),
    )
    for name, position, target in (
        ("hero", (8.2, 1.5, 10.6), (6.05, 2.2, 0.0)),
        ("court", (0.2, 1.7, -10.3), (2.9, 3.3, 3.0)),
        ("shade", (-8.3, 1.6, 3.3), (-5.9, 2.15, 12.0)),
    ):
        glb.place_camera(name, np.radians(60.0), 16 / 9, 0.05, 120.0, position, target)
    return glb
