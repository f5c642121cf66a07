# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German: the audit of robot descriptions, as Blender's window shows it. Its reports are English."""

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
    "robot_meshes_not_written": ("Die Meshes lassen sich nicht schreiben: {error}.",),
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
    "audit_text": ("Siehe den Text “{text}” im Texteditor",),
    "audit_copy_exists": (
        "{path} ist eine andere Datei und ginge verloren. Wählen Sie einen anderen Ordner, oder --force.",
    ),
    "audit_not_written": ("Die Datei lässt sich nicht schreiben: {error}.",),
}
