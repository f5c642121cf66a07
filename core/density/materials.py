# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pure data: densities of common materials, each with the source of its number, and units of
densities.

Real materials vary: woods by a fifth, alloys and plastics by some percent. If the mass of a part
matters, weigh the part and give its mass instead.
"""

from __future__ import annotations

from typing import NamedTuple

PNNL = (
    "PNNL-15870 Rev. 1 (2011), Compendium of Material Composition Data for Radiation Transport "
    'Modeling, "{:s}"'
)
NIST = 'NIST, Tables of X-Ray Mass Attenuation Coefficients (NISTIR 5632), table 2, "{:s}"'
INGEO = "NatureWorks, Ingeo Biopolymer 3D850 technical data sheet (ASTM D1505)"
CURA = 'UltiMaker, material profiles of Cura (fdm_materials), "{:s}"'
FILAMENT = "3D Printing Filament"
RESIN = "3D Printing Resin and Powder"
CRC = (
    "CRC Handbook of Chemistry and Physics, 97th ed. (2016), section 15, Density of Various "
    'Solids, "{:s}"'
)


class Material(NamedTuple):
    """A material with a unique name, a category from `CATEGORIES`, a density in kg/m³, and its
    source.
    """

    name: str
    category: str
    density: float
    source: str


def _materials_of(
    category: str, template: str, *entries: tuple[str, float, str]
) -> tuple[Material, ...]:
    return tuple(
        Material(name, category, density, template.format(entry))
        for name, density, entry in entries
    )


MATERIALS: tuple[Material, ...] = (
    Material("PLA", FILAMENT, 1240.0, INGEO),
    *_materials_of(
        FILAMENT,
        CURA,
        ("PETG", 1270.0, "Generic PETG"),
        ("ABS", 1100.0, "Generic ABS"),
        ("ASA", 1070.0, "Generic ASA"),
        ("TPU 95A", 1220.0, "Generic TPU 95A"),
        ("Nylon Filament", 1140.0, "Generic Nylon"),
        ("Polycarbonate Filament", 1190.0, "Generic PC"),
        ("Polypropylene Filament", 890.0, "Generic PP"),
        ("CPE", 1270.0, "Generic CPE"),
        ("PVA", 1230.0, "Generic PVA"),
    ),
    *_materials_of(
        RESIN,
        "typical of {:s}; the data sheet of what you print with is better",
        ("Resin, Standard", 1180.0, "cured acrylate resins, 1150 to 1200 kg/m³"),
        ("Resin, Clear", 1170.0, "clear stereolithography resins"),
        ("Resin, Tough", 1190.0, "tough stereolithography resins"),
        ("Resin, Rigid", 1210.0, "rigid stereolithography resins without filler"),
        ("Resin, PolyJet", 1185.0, "rigid clear PolyJet materials"),
        ("Resin, PolyJet Rubber-like", 1125.0, "rubber-like PolyJet materials"),
        ("Nylon 12, Laser Sintered", 930.0, "laser-sintered parts, which are porous"),
        ("Nylon 12, Multi Jet Fusion", 1010.0, "multi jet fusion parts"),
    ),
    *_materials_of(
        "Metals",
        PNNL,
        ("Aluminum", 2698.9, "Aluminum"),
        ("Aluminum 6061", 2700.0, "Aluminum, Alloy 6061-O"),
        ("Aluminum 7075", 2810.0, "Aluminum, Alloy 7075-O"),
        ("Brass", 8070.0, "Brass (Typical Composition)"),
        ("Bronze", 8400.0, "Bronze (Typical Composition)"),
        ("Cast Iron, Gray", 7150.0, "Iron, Cast (Gray)"),
        ("Chromium", 7180.0, "Chromium"),
        ("Copper", 8960.0, "Copper"),
        ("Gold", 19320.0, "Gold"),
        ("Inconel 718", 8190.0, "Inconel-718"),
        ("Iron", 7874.0, "Iron"),
        ("Lead", 11350.0, "Lead"),
        ("Magnesium", 1740.0, "Magnesium"),
        ("Nickel", 8902.0, "Nickel"),
        ("Platinum", 21450.0, "Platinum"),
        ("Silver", 10500.0, "Silver"),
        ("Stainless Steel 304", 8000.0, "Steel, Stainless 304"),
        ("Stainless Steel 440", 7800.0, "Steel, Stainless 440"),
        ("Steel, Carbon", 7820.0, "Steel, Carbon"),
        ("Tin", 7310.0, "Tin"),
        ("Titanium", 4540.0, "Titanium"),
        ("Titanium Ti-6Al-4V", 4430.0, "Titanium Alloy, Grade 5"),
        ("Tungsten", 19300.0, "Tungsten"),
    ),
    *_materials_of(
        "Plastics",
        PNNL,
        ("Acrylic (PMMA)", 1190.0, "Lucite"),
        ("Bakelite", 1250.0, "Bakelite"),
        ("Nylon 6", 1140.0, "Nylon, Type 6 and Type 6/6"),
        ("PET", 1380.0, "Polyethylene Terephthalate (PET)"),
        ("Polycarbonate", 1200.0, "Polycarbonate"),
        ("Polyethylene", 930.0, "Polyethylene, Non-borated"),
        ("Polyimide (Kapton)", 1420.0, "Kapton Polyimide Film"),
        ("Polypropylene", 900.0, "Polypropylene (PP)"),
        ("Polystyrene", 1060.0, "Polystyrene (PS)"),
        ("PTFE (Teflon)", 2250.0, "Polytetrafluoroethylene (PTFE)"),
        ("PVC", 1406.0, "Polyvinyl Chloride (PVC)"),
        ("PVDF (Kynar)", 1790.0, "Kynar"),
    ),
    *_materials_of(
        "Rubber and Foam",
        PNNL,
        ("Polyurethane Foam", 21.0, "Polyurethane Foam (PUR)"),
        ("Rubber, Butyl", 920.0, "Rubber, Butyl"),
        ("Rubber, Natural", 920.0, "Rubber, Natural"),
        ("Rubber, Neoprene", 1230.0, "Rubber, Neoprene"),
        ("Rubber, Silicone", 1018.5, "Rubber, Silicon"),
    ),
    *_materials_of(
        "Wood",
        PNNL,
        ("Ash, White", 670.0, "Wood, Ash (white)"),
        ("Balsa", 120.0, "Wood, Balsa"),
        ("Birch", 710.0, "Wood, Birch"),
        ("Cedar", 350.0, "Wood, Ceder"),
        ("Cherry", 430.0, "Wood, Cherry"),
        ("Douglas Fir", 510.0, "Wood, Fir (douglas)"),
        ("Elm", 560.0, "Wood, Elm"),
        ("Hardboard", 1300.0, "Masonite"),
        ("Hickory", 770.0, "Wood, Hickory"),
        ("Mahogany", 700.0, "Wood, Mahogany"),
        ("Maple, Sugar", 680.0, "Wood, Maple (sugar)"),
        ("Oak, Red", 670.0, "Wood, Oak (black or red)"),
        ("Oak, White", 770.0, "Wood, Oak (white)"),
        ("Pine, White", 430.0, "Wood, Pine (white)"),
        ("Pine, Yellow", 710.0, "Wood, Pine (yellow)"),
    ),
    *_materials_of(
        "Stone and Building",
        PNNL,
        ("Asphalt Pavement", 2578.4, "Asphalt Pavement"),
        ("Basalt", 3010.0, "Rock, Basalt"),
        ("Brick", 1800.0, "Brick, Common Silica"),
        ("Clay", 2200.0, "Clay"),
        ("Concrete", 2300.0, "Concrete, Regular"),
        ("Earth", 1520.0, "Earth, U.S. Average"),
        ("Granite", 2690.0, "Rock, Granite"),
        ("Gypsum", 2320.0, "Gypsum (Plaster of Paris)"),
        ("Limestone", 2610.0, "Rock, Limestone"),
        ("Sand", 1700.0, "Sand"),
        ("Sandstone", 2320.0, "Rock, Sandstone"),
    ),
    *_materials_of(
        "Glass and Ceramics",
        PNNL,
        ("Alumina", 3970.0, "Aluminum Oxide"),
        ("Glass Fiber, E", 2565.0, "Fiberglass, Type E"),
        ("Glass, Lead", 6220.0, "Glass, Lead"),
        ("Glass, Plate", 2400.0, "Glass, Plate"),
        ("Graphite", 1700.0, "Carbon, Graphite (Reactor Grade)"),
        ("Quartz", 2648.0, "Silicon Dioxide (Alpha-quartz)"),
        ("Silicon", 2330.0, "Silicon"),
        ("Silicon Carbide", 3210.0, "Silicon Carbide (Hexagonal)"),
    ),
    *_materials_of(
        "Glass and Ceramics", NIST, ("Glass, Borosilicate", 2230.0, "Glass, Borosilicate (Pyrex)")
    ),
    *_materials_of(
        "Liquids",
        PNNL,
        ("Ethanol", 789.3, "Ethyl Alcohol"),
        ("Gasoline", 721.0, "Gasoline"),
        ("Glycerol", 1261.3, "Glycerol"),
        ("Kerosene", 819.0, "Kerosene"),
        ("Mercury", 13546.0, "Mercury"),
        ("Oil, Hydraulic", 871.0, "Oil, Hydraulic"),
        ("Sea Water", 1023.343, "Sea Water, Standard"),
        ("Water", 998.207, "Water, Liquid"),
    ),
    *_materials_of(
        "Body and Nature",
        PNNL,
        ("Blood", 1060.0, "Blood (ICRP)"),
        ("Bone, Cortical", 1850.0, "Bone, Cortical (ICRP)"),
        ("Fat", 920.0, "Tissue, Adipose (ICRP)"),
        ("Felt", 185.0, "Felt"),
        ("Muscle", 1040.0, "Muscle, Skeletal (ICRP)"),
        ("Paraffin Wax", 930.0, "Wax, Paraffin"),
        ("Skin", 1100.0, "Skin (ICRP)"),
        ("Soft Tissue", 1000.0, "Tissue, Soft (ICRP)"),
    ),
    *_materials_of("Body and Nature", CRC, ("Ice", 917.0, "Ice")),
)

CATEGORIES: tuple[str, ...] = tuple(dict.fromkeys(material.category for material in MATERIALS))
BY_NAME: dict[str, Material] = {material.name: material for material in MATERIALS}

# CT numbers in Hounsfield units to kg/m³: air, fat, water and soft tissue, bone, after Schneider,
# Bortfeld and Schlegel (Phys. Med. Biol. 45, 2000), as the table of densities that comes with GATE
# has them.
CT_DENSITIES = (
    "-1000 1.21, -98 930, -97 930.486, 14 1030, 23 1031, 100 1119.9, 101 1076.2, 1600 1964.2, 3000 "
    "2800"
)

POUND = 0.45359237  # kg
FOOT = 0.3048  # m
DENSITY_UNITS = {  # name of a setting → kg/m³, unit
    "KG_M3": (1.0, "kg/m³"),
    "G_CM3": (1e3, "g/cm³"),
    "LB_IN3": (POUND / (FOOT / 12.0) ** 3, "lb/in³"),
    "LB_FT3": (POUND / FOOT**3, "lb/ft³"),
}
# The customary units of tables, not kg/mm³.
SYSTEM_UNITS = {
    "METRIC": "KG_M3",
    "IMPERIAL": "LB_FT3",
    "NONE": "KG_M3",
}


def density_unit(chosen: str, system: str) -> str:
    """Return a key of `DENSITY_UNITS`: `chosen`, or for "AUTO" the key for a unit system
    (`SYSTEM_UNITS`).
    """
    return SYSTEM_UNITS[system] if chosen == "AUTO" else chosen
