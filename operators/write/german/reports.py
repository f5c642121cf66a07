# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German messages about reports, panels, stability and robots."""

# Codes of messages → German, and for several where the English has such a text
MESSAGES = {
    "joint_not_added": ("Blender hat das Gelenk nicht angelegt. Prüfen, ob die Szene eine Starrkörperwelt hat.",),
    "rigid_bodies_made": (
        "{count} Starrkörper von {mass:.7g} kg; Masse berechnen würde {calculated:.7g} kg sagen",
        "{count} Starrkörper von {mass:.7g} kg; Masse berechnen würde {calculated:.7g} kg sagen",
    ),
    "stale_member": ("Ein Mitglied hat sich geändert oder wurde neu gemessen",),
    "stale_members": ("Mitglieder wurden hinzugefügt, entfernt oder bewegt, oder gegebene Massen haben sich geändert",),
    "stale_fingerprint": ("Fingerabdruck beschädigt",),
    "stale_settings": ("Einstellungen geändert",),
    "stale_geometry": ("Geometrie geändert",),
    "stale_transform": ("Transformation geändert",),
    "stale_scale": ("Skalierung geändert",),
    "stale_unit_scale": ("Einheitenmaßstab geändert",),
    "stale_results": ("Veraltet: das Objekt hat sich nach der Messung geändert. Es neu messen.",),
    "no_stored_results": ("Keine gespeicherten Ergebnisse. Das Objekt messen.",),
    "nothing_measurable": ("Nichts Ausgewähltes lässt sich messen",),
    "nothing_to_do": ("Nichts zu tun: {cause}",),
    "left_unchanged": ("{count} von {total} unverändert gelassen: {causes}",),
    "failure": ("{object}: {cause}",),
    "refused": ("{object}: {cause}",),
    "and_more": ("und {count} weitere",),
    "measured_one": ("{object} gemessen",),
    "measured_one_with_warnings": ("{object} gemessen, mit Warnungen",),
    "measured_several": ("{count} von {total} Objekten gemessen",),
    "with_warnings": ("{count} mit Warnungen: {objects}",),
    "object_warnings": ("{object}: {causes}",),
    "measured_section": ("Querschnitt von {object} gemessen",),
    "measured_section_with_warnings": ("Querschnitt von {object} gemessen, mit Warnungen",),
    "measured_sections": ("{count} Querschnitt gemessen", "{count} Querschnitte gemessen"),
    "no_defects": ("{count} Objekt gemessen: keine Fehlerstellen", "{count} Objekte gemessen: keine Fehlerstellen"),
    "with_defects": (
        "{count} von {total} gemessenen Objekten hat Fehlerstellen",
        "{count} von {total} gemessenen Objekten haben Fehlerstellen",
    ),
    "object_defects": ("{object}: {defects}",),
    "results_removed": ("Ergebnisse von {count} Objekt entfernt", "Ergebnisse von {count} Objekten entfernt"),
    "no_results_to_remove": ("Die ausgewählten Objekte haben keine Ergebnisse",),
    "value_copied": ("{value} kopiert",),
    "no_value_to_copy": ("Kein Wert zu kopieren",),
    "csv_copied": ("{count} Zeile kopiert.", "{count} Zeilen kopiert."),
    "numbers_saved": ("{count} Objekt in „{file}“ gespeichert.", "{count} Objekte in „{file}“ gespeichert."),
    "numbers_suffix": (
        "Das Format von „{file}“ ist unbekannt. Lassen Sie den Namen auf .csv, .json oder .jsonl enden.",
    ),
    "report_copied": ("Bericht von {count} Objekt kopiert", "Bericht von {count} Objekten kopiert"),
    "section_copied": ("Querschnitt von {object} kopiert",),
    "moments_computed": ("{count} Momente von {object} berechnet",),
    "moments_copied": ("{count} Momente kopiert",),
    "wire_without_moments": (
        "{object}: ein Draht hat kein Volumen und keine Oberfläche. Art auf Massiv oder Schale setzen; measure "
        "--order gibt Momente der Länge.",
    ),
    "aligned_to_world": (
        "{count} Objekt an den Weltachsen ausgerichtet",
        "{count} Objekte an den Weltachsen ausgerichtet",
    ),
    "already_aligned": ("schon ausgerichtet",),
    "cursor_moved": (
        "3D-Cursor auf den Massenmittelpunkt von {count} Objekt bewegt",
        "3D-Cursor auf den Massenmittelpunkt von {count} Objekten bewegt",
    ),
    "empties_placed": (
        "Ein Empty in das Hauptachsensystem von {count} Objekt gesetzt",
        "Empties in die Hauptachsensysteme von {count} Objekten gesetzt",
    ),
    "empties_in_place": ("die Empties sind am Ort",),
    "origins_moved": (
        "Ursprung von {count} Objekt in den Massenmittelpunkt bewegt",
        "Ursprünge von {count} Objekten in den Massenmittelpunkt bewegt",
    ),
    "axes_made_principal": (
        "Achsen von {count} Objekt auf seine Hauptträgheitsachsen ausgerichtet",
        "Achsen von {count} Objekten auf ihre Hauptträgheitsachsen ausgerichtet",
    ),
    "already_in_place": ("schon am Ort",),
    "orientation_created": ("Transformationsorientierung „{name}“ angelegt",),
    "node_group_added": ("Knotengruppe „{group}“ hinzugefügt",),
    "node_marker_added": ("Knotengruppe „{group}“ und Markierung „{object}“ hinzugefügt",),
    "no_reversed_faces": ("keine Flächen wurden umgedreht gemessen",),
    "faces_reversed": ("{count} Fläche umgedreht", "{count} Flächen umgedreht"),
    "material_set": ("{count} Objekt auf {material} gesetzt", "{count} Objekte auf {material} gesetzt"),
    "material_set_already": ("schon auf {material} gesetzt",),
    "blender_material_set": ("„{target}“ auf {material} gesetzt",),
    "settings_copied": ("Einstellungen auf {count} Objekt kopiert", "Einstellungen auf {count} Objekte kopiert"),
    "settings_equal": ("die Einstellungen sind gleich",),
    "rigid_body_masses_set": (
        "Starrkörpermasse von {count} Objekt gesetzt",
        "Starrkörpermassen von {count} Objekten gesetzt",
    ),
    "rigid_body_masses_equal": ("die Massen sind gleich",),
    "balanced": (
        "{count} Punkt um höchstens {distance:length} bewegt; der Massenmittelpunkt ging von {start:point} nach "
        "{end:point}",
        "{count} Punkte um höchstens {distance:length} bewegt; der Massenmittelpunkt ging von {start:point} nach "
        "{end:point}",
    ),
    "poses_matched": ("{count} Objekt auf {object} bewegt", "{count} Objekte auf {object} bewegt"),
    "pose_distance": ("{object}: Oberflächen höchstens {maximum:length} auseinander, im Mittel {mean:length}",),
    "pose_not_a_copy": (
        "{object}: Oberflächen höchstens {maximum:length} auseinander, im Mittel {mean:length}; keine Kopie, oder "
        "abgeschnitten",
    ),
    "shapes_compared": ("{count} Form verglichen", "{count} Formen verglichen"),
    "shape_counts": ("{counts}",),
    "shapes_copy": ("{count} Kopie", "{count} Kopien"),
    "shapes_scaled_copy": ("{count} skalierte Kopie", "{count} skalierte Kopien"),
    "shapes_mirror": ("{count} Spiegelbild", "{count} Spiegelbilder"),
    "shapes_scaled_mirror": ("{count} skaliertes Spiegelbild", "{count} skalierte Spiegelbilder"),
    "shapes_copy_or_mirror": ("{count} Kopie oder Spiegelbild", "{count} Kopien oder Spiegelbilder"),
    "shapes_scaled_copy_or_mirror": (
        "{count} skalierte Kopie oder skaliertes Spiegelbild",
        "{count} skalierte Kopien oder Spiegelbilder",
    ),
    "shapes_similar": ("{count} ähnlich",),
    "none_similar": ("keine ist ähnlich",),
    "nearest_shape": ("am nächsten ist {object}, mit {distance:.2e}",),
    "object_not_in_view_layer": ("Kein Objekt {object} in der Ansichtsebene",),
    "records_left_out": ("Weggelassen: {causes}",),
    "library_file_unreadable": ("{file} lässt sich nicht lesen: {error}",),
    "symmetry_found": ("{object}: {group}, {description}",),
    "symmetry_found_of_display_mesh": ("{object}: {group}, {description}, des Anzeigenetzes",),
    "symmetry_searched": ("{count} Objekt untersucht", "{count} Objekte untersucht"),
    "symmetry_sphere": ("Kugel",),
    "symmetry_revolution": ("Rotationskörper",),
    "symmetry_revolution_reversible": ("Rotationskörper, an beiden Enden gleich",),
    "symmetry_axes": ("{count} Drehachse, {order}-zählig", "{count} Drehachsen, bis zu {order}-zählig"),
    "symmetry_planes": ("{count} Spiegelebene", "{count} Spiegelebenen"),
    "symmetry_inversion": ("Inversionszentrum",),
    "symmetry_none": ("keine Symmetrie",),
    "fourier_written": ("{count} Frequenzen in {file} geschrieben; das Bild {image} zeigt Schnitte ihres Betrags",),
    "scan_imported": ("{samples:size} Abtastwerte als „{file}“ importiert",),
    "canceled_measuring": ("Messen abgebrochen; nichts wurde geändert",),
    "canceled_search": ("Suche abgebrochen; nichts wurde geändert",),
    "canceled_match_pose": ("Lage angleichen abgebrochen; nichts wurde bewegt",),
    "canceled_fourier": ("Fourier-Transformation abgebrochen; nichts wurde geschrieben",),
    "progress_measuring": ("Messen: {share:.0%}. Esc bricht ab",),
    "progress_comparing": ("Vergleichen: {share:.0%}. Esc bricht ab",),
    "progress_symmetry": ("Symmetrie suchen: {share:.0%}. Esc bricht ab",),
    "progress_fourier": ("Fourier-Transformation: {share:.0%}. Esc bricht ab",),
    "poll_object_mode": ("In den Objektmodus wechseln",),
    "poll_select_objects": ("Objekte auswählen",),
    "poll_select_meshes": ("Netzobjekte auswählen",),
    "poll_measure_selected": ("Zuerst die ausgewählten Objekte messen",),
    "poll_measure_section": ("Zuerst einen Querschnitt messen",),
    "poll_compute_moments": ("Zuerst die Momente berechnen",),
    "poll_active_wanted": ("Ein Objekt zum Vergleichen aktivieren",),
    "poll_active_measurable": ("Ein messbares Objekt aktivieren",),
    "poll_active_surface": ("Ein Objekt mit einer Oberfläche aktivieren",),
    "poll_active_selected": ("Ein Objekt aktivieren und auswählen",),
    "poll_active_mesh": ("Ein Netzobjekt aktivieren",),
    "poll_match_selection": ("Die zu bewegenden Objekte auswählen, dann das Ziel",),
    "poll_edit_vertices": ("In den Bearbeitungsmodus wechseln und die Punkte auswählen, die sich bewegen dürfen",),
    "poll_vertices_or_group": (
        "Im Bearbeitungsmodus die Punkte auswählen, die sich bewegen dürfen, oder eine Punktgruppe hinzufügen",
    ),
    "poll_section": ("Flächen im Bearbeitungsmodus auswählen oder ein ebenes Netz, eine 2D-Kurve oder einen Text",),
    "poll_select_others": ("Neben dem aktiven weitere Objekte auswählen",),
    "panel_override": (
        "Bibliotheksüberschreibung: Einstellungen und Ergebnisse gehen beim Speichern verloren. Sie lokal machen.",
    ),
    "panel_wall_limit": ("Dickste Wand: {length:length}",),
    "panel_wall_folds": ("Faltet sich ab {length:length}",),
    "panel_density_mean": ("Mittlere Dichte, aus: {cause}",),
    "panel_no_material_slots": ("Keine Materialplätze",),
    "panel_unit_question": ("{length} lang und {mass}: ist eine Einheit dieser Szene ein Millimeter?",),
    "panel_live_first_order": (
        "Live: Masse, Volumen und Schwerpunkt dieses Bildes; das Trägheitsmoment folgt, wenn es anhält "
        "({milliseconds:.0f} ms)",
    ),
    "panel_live_behind": (
        "Live hängt nach: Messen dauert {milliseconds:.0f} ms und wartet, bis die Bearbeitung endet",
    ),
    "panel_posed": ("Summe von {count} Mesh der Armatur", "Summe von {count} Meshes der Armatur"),
    "panel_posed_missing": ("Nicht gemessen: {objects}",),
    "panel_posed_stale": ("Veraltet: {objects}",),
    "panel_live": ("Live ({milliseconds:.0f} ms). Zum Speichern Messen drücken",),
    "panel_orders_copied": ("Ordnungen {first} bis {last} sind nur in der Kopie.",),
    "panel_symmetry_tolerance": ("Die Oberfläche deckt sich mit ihren Bildern auf {share:.2g} des Trägheitsradius",),
    "panel_symmetry_tolerance_of_display_mesh": (
        "Das Anzeigenetz deckt sich mit seinen Bildern auf {share:.2g} des Trägheitsradius",
    ),
    "panel_symmetry_of_moments": ("Momente bis zur Ordnung 6 allein erlauben {group}",),
    "panel_equal_moments_all": ("Alle Hauptträgheitsmomente sind gleich",),
    "panel_equal_moments_12": ("Hauptträgheitsmomente 1 und 2 sind gleich",),
    "panel_equal_moments_23": ("Hauptträgheitsmomente 2 und 3 sind gleich",),
    "panel_fourier_default": ("0 rad/m: aus der Größe des Objekts",),
    "panel_nothing_measured": ("Kein ausgewähltes Objekt ist gemessen",),
    "panel_nothing_to_compare": ("Nichts zum Vergleichen",),
    "panel_material_default": ("Keine: die Dichte des Objekts gilt",),
    "hull_without_extent": ("Alle Punkte liegen auf einer Geraden: nichts kann darauf stehen.",),
    "center_outside_hull": (
        "Der Massenmittelpunkt liegt außerhalb der konvexen Hülle: kein Körper kann ihn dort haben. Oberfläche und "
        "Dichte prüfen.",
    ),
    "no_stable_pose": ("In keiner Lage kommt es zur Ruhe: es rollt weiter.",),
    "hull_simplified": (
        "„{object}“ ist fein unterteilt: seine konvexe Hülle wird mit {corners} Ecken genommen, auf {share:percent} "
        "seiner Größe",
    ),
    "stability_computed": ("{count} von {total} Objekten steht", "{count} von {total} Objekten stehen"),
    "objects_tip": ("{names} kippt um", "{names} kippen um"),
    "laid_on_ground": ("{count} Objekt auf den Boden gelegt", "{count} Objekte auf den Boden gelegt"),
    "already_on_ground": ("schon auf dem Boden",),
    "poll_object_or_pose_mode": ("In den Objektmodus oder Posenmodus wechseln",),
    "progress_balance": ("Massenmittelpunkt wird verfolgt: {share:percent}. Esc zum Abbrechen",),
    "canceled_balance": ("Abgebrochen: nichts wurde geändert",),
    "no_such_collection": ("Es gibt keine Sammlung „{collection}“. Eine andere wählen.",),
    "balance_group_without_contacts": (
        "„{collection}“ hat kein Objekt mit einer Oberfläche. Eine andere Sammlung wählen.",
    ),
    "balance_group_empty_group": (
        "Nichts, dem zu folgen wäre. Objekte mit einer Oberfläche auswählen oder eine Armatur, die welche verformt.",
    ),
    "balance_group_without_mass": ("Zusammen haben die Objekte keine Masse. Ihre Dichten setzen.",),
    "balance_group_made": (
        "„{empty}“ hat {count} Schlüsselbild des Massenmittelpunkts; Objekte: {objects_count}",
        "„{empty}“ hat {count} Schlüsselbilder des Massenmittelpunkts; Objekte: {objects_count}",
    ),
    "balance_group_inside": ("Er liegt bei {count} von {total} Bildern über dem Standpolygon",),
    "panel_stability_unknown": ("Die Standfestigkeit wurde nicht berechnet.",),
    "panel_stability_stale": ("Die Geometrie hat sich geändert. Prüfen Sie noch einmal.",),
    "robot_links_left_out": (
        "{count} Objekt ohne Masse ist kein Glied: {links}.",
        "{count} Objekte ohne Masse sind keine Glieder: {links}.",
    ),
    "robot_without_links": ("Es gibt kein Glied. Objekte mit Masse messen.",),
    "robot_without_bones": ("Es gibt kein Glied. Eine Armatur mit dem, was sie bewegt, auswählen.",),
    "robot_base_added": (
        "{count} Objekte haben kein Elternobjekt. Sie sind an einem zusätzlichen Glied ohne Masse fest, {name}. Sie "
        "an eines davon hängen, um das zu vermeiden.",
    ),
    "robot_ellipsoid_as_box": (
        "URDF hat kein Ellipsoid. An seiner Stelle steht der Quader von gleicher Masse und Trägheit: {links}.",
    ),
    "urdf_effort_unknown": (
        "Kraft und Geschwindigkeit des Gelenks auf die seines Motors setzen. Es sind Platzhalter: {joints}.",
        "Kraft und Geschwindigkeit von {count} Gelenken auf die ihrer Motoren setzen. Es sind Platzhalter: {joints}.",
    ),
    "sdf_limits_lost": (
        "SDF kennt keine Grenzen eines Gelenks um mehrere Achsen. Es bewegt sich frei: {joints}.",
        "SDF kennt keine Grenzen von Gelenken um mehrere Achsen. {count} bewegen sich frei: {joints}.",
    ),
    "left_out_of_robot": ("{count} von {total} Objekten sind keine Glieder: {causes}",),
    "robot_exported": ("{count} Glied nach {file} exportiert.", "{count} Glieder nach {file} exportiert."),
    "robot_scaled": (
        "Leser sind sich über skalierte Körper uneins. Die Skalierung von {links} anwenden (Objekt > Anwenden > "
        "Skalierung).",
    ),
    "robot_sheared": (
        "Körper dürfen nicht geschert sein. Die Skalierung der Eltern von {links} anwenden (Objekt > Anwenden > "
        "Skalierung).",
    ),
    "robot_names_alike": ("Blender gibt {names} in USD einen Namen. Eines umbenennen.",),
    "gltf_node_missing": (
        "{count} Glied hat in der Datei keinen eigenen Knoten: {links}.",
        "{count} Glieder haben in der Datei keine eigenen Knoten: {links}.",
    ),
    "gltf_unit_scale": (
        "Blender schreibt seine Einheiten als Meter nach glTF. Mittelpunkt und Trägheit stehen darin, mit {scale:g} "
        "m je Einheit.",
    ),
    "gltf_unreadable": ("Blenders Exporter hat keine glTF-Datei geschrieben.",),
    "robot_geometry_not_written": ("Blenders Exporter ist gescheitert: {error}.",),
    "robot_not_written": ("Die Datei lässt sich nicht schreiben: {error}.",),
    "robot_copied": ("Inertial von {count} Glied kopiert.", "Inertials von {count} Gliedern kopiert."),
    "primitives_added": ("{count} Form hinzugefügt", "{count} Formen hinzugefügt"),
    "primitive_has_parent": (
        "Es hat ein Elternobjekt oder ist verknüpft. Das Elternobjekt lösen, um es zu simulieren.",
    ),
    "robot_meshes_written": ("{count} Netz nach {folder} geschrieben.", "{count} Netze nach {folder} geschrieben."),
    "mjcf_inertia_too_small": (
        "MuJoCo weist einen bewegten Körper mit einer Masse oder einem Hauptmoment unter {limit:g} kg oder kg·m² "
        "zurück: {links}, mit {least:.3g}. boundmass und boundinertia des Compilers setzen, ihn an seinem "
        "Elternobjekt festmachen oder in größeren Einheiten modellieren.",
        "MuJoCo weist bewegte Körper mit einer Masse oder einem Hauptmoment unter {limit:g} kg oder kg·m² zurück: "
        "{count} davon, {links}, bis hinab zu {least:.3g}. boundmass und boundinertia des Compilers setzen, sie an "
        "ihren Elternobjekten festmachen oder in größeren Einheiten modellieren.",
    ),
    "usd_inertia_too_small": (
        "Die Trägheit von {links} ist zu klein für die einfache Genauigkeit von PhysicsMassAPI. newton:inertia "
        "lesen oder eine Stage in kleineren Einheiten verwenden.",
    ),
    "defect_boundary_edges": ("{count} Randkante", "{count} Randkanten"),
    "defect_non_manifold_edges": (
        "{count} Kante mit mehr als zwei Flächen",
        "{count} Kanten mit mehr als zwei Flächen",
    ),
    "defect_inconsistent_edges": (
        "{count} Kante mit entgegengesetzten Normalen",
        "{count} Kanten mit entgegengesetzten Normalen",
    ),
    "defect_inverted_components": ("{count} umgestülpte Komponente", "{count} umgestülpte Komponenten"),
    "defect_nested_components": (
        "{count} Komponente in einer anderen, doppelt gezählt",
        "{count} Komponenten in anderen, doppelt gezählt",
    ),
    "defect_overlapping_components": ("{count} überlappende Komponente", "{count} überlappende Komponenten"),
    "defect_cavities": ("{count} Hohlraum", "{count} Hohlräume"),
    "defect_duplicate_faces": ("{count} doppelte Fläche", "{count} doppelte Flächen"),
    "defect_degenerate_faces": ("{count} Fläche ohne Inhalt", "{count} Flächen ohne Inhalt"),
    "defect_non_planar_faces": ("{count} unebene Fläche", "{count} unebene Flächen"),
    "defect_flipped_faces": ("{count} verdrehte Fläche", "{count} verdrehte Flächen"),
}
