# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of materials beside rounded values that engineers' tables agree on: a slip of a digit is
seen.
"""

import pytest
from body_moments.core.density.materials import BY_NAME, MATERIALS

# g/cm³, rounded
ROUNDED = """
PLA 1.24; PETG 1.27; ABS 1.05; ASA 1.07; TPU 95A 1.2; Nylon Filament 1.13;
Polycarbonate Filament 1.2; Polypropylene Filament 0.9; CPE 1.27; PVA 1.22;
Resin, Standard 1.15; Resin, Clear 1.17; Resin, Tough 1.2; Resin, Rigid 1.2;
Resin, PolyJet 1.18; Resin, PolyJet Rubber-like 1.13; Nylon 12, Laser Sintered 0.95;
Nylon 12, Multi Jet Fusion 1.0; Aluminum 2.7; Aluminum 6061 2.7; Aluminum 7075 2.8; Brass 8.4;
Bronze 8.8; Cast Iron, Gray 7.2; Chromium 7.2; Copper 8.9; Gold 19.3; Inconel 718 8.2; Iron 7.9;
Lead 11.3; Magnesium 1.74; Nickel 8.9; Platinum 21.5; Silver 10.5; Stainless Steel 304 8.0;
Stainless Steel 440 7.7; Steel, Carbon 7.85; Tin 7.3; Titanium 4.5; Titanium Ti-6Al-4V 4.43;
Tungsten 19.3; Acrylic (PMMA) 1.18; Bakelite 1.3; Nylon 6 1.14; PET 1.38; Polycarbonate 1.2;
Polyethylene 0.94; Polyimide (Kapton) 1.42; Polypropylene 0.9; Polystyrene 1.05;
PTFE (Teflon) 2.2; PVC 1.4; PVDF (Kynar) 1.78; Polyurethane Foam 0.02; Rubber, Butyl 0.92;
Rubber, Natural 0.93; Rubber, Neoprene 1.23; Rubber, Silicone 1.1; Ash, White 0.67; Balsa 0.13;
Birch 0.68; Cedar 0.36; Cherry 0.5; Douglas Fir 0.51; Elm 0.56; Hardboard 1.2; Hickory 0.8;
Mahogany 0.65; Maple, Sugar 0.7; Oak, Red 0.69; Oak, White 0.75; Pine, White 0.42;
Pine, Yellow 0.67; Asphalt Pavement 2.4; Basalt 2.9; Brick 1.9; Clay 2.1; Concrete 2.35;
Earth 1.5; Granite 2.7; Gypsum 2.3; Limestone 2.6; Sand 1.6; Sandstone 2.3; Alumina 3.95;
Glass Fiber, E 2.58; Glass, Lead 6.2; Glass, Plate 2.5; Graphite 1.8; Quartz 2.65; Silicon 2.33;
Silicon Carbide 3.2; Glass, Borosilicate 2.23; Ethanol 0.79; Gasoline 0.74; Glycerol 1.26;
Kerosene 0.81; Mercury 13.55; Oil, Hydraulic 0.87; Sea Water 1.025; Water 1.0; Blood 1.06;
Bone, Cortical 1.9; Fat 0.92; Felt 0.18; Muscle 1.05; Paraffin Wax 0.92; Skin 1.1;
Soft Tissue 1.03; Ice 0.92
"""
TABLE = {
    name: 1000.0 * float(value)
    for name, _, value in (
        entry.strip().rpartition(" ") for entry in ROUNDED.replace("\n", " ").split(";")
    )
}


def test_the_table_here_is_of_the_same_materials():
    assert set(TABLE) == set(BY_NAME) and len(BY_NAME) == len(MATERIALS)


@pytest.mark.parametrize("material", MATERIALS, ids=lambda material: material.name)
def test_material_density_is_near_engineers_tables(material):
    assert 0.85 < material.density / TABLE[material.name] < 1.15
