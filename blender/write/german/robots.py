# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German: robots that are exported, and the audit of their descriptions as Blender's window shows it. Its reports are
English.
"""

TEXTS = {
    "Audit Robot Description": "Roboterbeschreibung prüfen",
    "Check mass, center and inertia in a robot description against its meshes. What is found becomes a text": (
        "Masse, Schwerpunkt und Trägheit in einer Roboterbeschreibung an ihren Meshes prüfen. Was sich findet, wird "
        "ein Text"
    ),
    "Robot Description for Audit (.urdf/.sdf/.xml/.usda)": "Roboterbeschreibung zum Prüfen (.urdf/.sdf/.xml/.usda)",
    "Mesh Folder": "Ordner der Meshes",
    "A folder that meshes may be in, besides that of the file and of its package": (
        "Ein Ordner, in dem Meshes liegen dürfen, außer dem der Datei und dem ihres Pakets"
    ),
    "Meshes Anywhere": "Meshes überall",
    "Read meshes wherever they are": "Meshes lesen, wo immer sie liegen",
    "Write Repaired Copy": "Reparierte Kopie schreiben",
    "Write a copy with _repaired in its name beside the file": (
        "Eine Kopie mit _repaired im Namen neben die Datei schreiben"
    ),
    "Write HTML": "HTML schreiben",
    "Write the report as a page beside the file": "Den Bericht als Seite neben die Datei schreiben",
}
MESSAGES = {
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
        "Das Format hat kein Ellipsoid. An seiner Stelle steht der Quader von gleicher Masse und Trägheit: {links}.",
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
        "Blender schreibt seine Einheiten als Meter nach glTF: ein Knoten über allen anderen skaliert sie mit "
        "{scale:g}. Skalierte Körper lesen Programme verschieden.",
    ),
    "gltf_unreadable": ("Blenders Exporter hat keine glTF-Datei geschrieben.",),
    "robot_geometry_not_written": ("Blenders Exporter ist gescheitert: {error}.",),
    "robot_not_written": ("Die Datei lässt sich nicht schreiben: {error}.",),
    "robot_copied": ("Inertial von {count} Glied kopiert.", "Inertials von {count} Gliedern kopiert."),
    "primitives_added": ("{count} Form hinzugefügt", "{count} Formen hinzugefügt"),
    "primitive_has_parent": (
        "Es hat ein Elternobjekt oder ist verknüpft. Das Elternobjekt lösen, um es zu simulieren.",
    ),
    "robot_links_bare": (
        "{count} Glied hat keine Geometrie: {links}.",
        "{count} Glieder haben keine Geometrie: {links}.",
    ),
    "mjcf_inertia_too_small": (
        "MuJoCo weist einen bewegten Körper mit einer Masse oder einem Hauptmoment unter {limit:g} kg oder kg·m² "
        "zurück: {links}, mit {least:.3g}. boundmass und boundinertia des Compilers setzen, ihn an seinem "
        "Elternobjekt festmachen oder in größeren Einheiten modellieren.",
        "MuJoCo weist bewegte Körper mit einer Masse oder einem Hauptmoment unter {limit:g} kg oder kg·m² zurück: "
        "{count} davon, {links}, bis hinab zu {least:.3g}. boundmass und boundinertia des Compilers setzen, sie an "
        "ihren Elternobjekten festmachen oder in größeren Einheiten modellieren.",
    ),
    "mjcf_mesh_too_large": (
        "MuJoCo weist Netze mit mehr als {limit} Dreiecken zurück: {links}. Sie mit einem Dezimieren-Modifikator "
        "verkleinern oder die Geometrie weglassen.",
    ),
    "usd_inertia_too_small": (
        "Die Trägheit von {links} ist zu klein für die einfache Genauigkeit von PhysicsMassAPI. newton:inertia "
        "lesen oder eine Stage in kleineren Einheiten verwenden.",
    ),
    "robot_meshes_not_written": ("Die Meshes lassen sich nicht schreiben: {error}.",),
    "result_foreign_file": ("{path} ist kein Ergebnis von body_moments und ginge verloren",),
    "xml_entities": (
        "Die Datei vereinbart einen Dokumenttyp, mit dem sich Entitäten vereinbaren ließen. Er muss entfernt werden.",
    ),
    "xml_too_large": ("Die Datei schachtelt mehr als {depth} Elemente oder hat mehr als {limit}.",),
    "xml_invalid": ("Die Datei ist kein XML: {error}.",),
    "usda_invalid": ("Die Datei ist kein USD als Text (Zeile {line}).",),
    "usd_not_text": ("USD wird nur als Text gelesen. Mit usdcat lässt sich die Datei in .usda umwandeln.",),
    "description_unknown": ("Die Datei ist keine Roboterbeschreibung. Ihr erstes Element ist {tag}.",),
    "description_without_links": ("Die Datei hat keine Glieder.",),
    "description_too_large": ("Die Datei ist größer als {limit} MB oder hat zu viele Glieder.",),
    "include_unreadable": (
        "Eine eingebundene Datei lässt sich nicht lesen: {name}. Ihren Ordner mit --root nennen oder mit "
        "--allow-outside alle erlauben.",
    ),
    "include_twice": ("Eine Datei wird zweimal eingebunden: {name}.",),
    "audit_done": ("{links} Glieder: {errors} Fehler, {warnings} Warnungen, {notes} Hinweise",),
    "audit_text": ("Siehe den Text „{text}“ im Texteditor",),
    "audit_copy_exists": (
        "{path} ist eine andere Datei und ginge verloren. Wählen Sie einen anderen Ordner, oder --force.",
    ),
    "audit_not_written": ("Die Datei lässt sich nicht schreiben: {error}.",),
}
