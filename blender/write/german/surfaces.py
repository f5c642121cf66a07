# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German messages about files of surfaces."""

MESSAGES = {
    "iges_unrecognized": ("Keine IGES-Datei in fester ASCII-Form: Einer Zeile fehlt der Abschnitt in Spalte 73.",),
    "iges_not_ascii": ("Die IGES-Datei ist binär oder komprimiert. Sie in fester ASCII-Form speichern.",),
    "iges_damaged": ("Die IGES-Datei ist beschädigt: {cause}. Sie neu exportieren.",),
    "iges_global_section": ("ihr globaler Abschnitt ist unvollständig oder unmöglich",),
    "iges_directory": ("ihr Verzeichniseintrag {number} besteht nicht aus zwei Zeilen ganzer Zahlen",),
    "iges_unit": ("Die IGES-Datei hat die unbekannte Einheit „{unit}“. Sie in Millimetern oder Metern exportieren.",),
    "obj_call": ("Die Datei ruft mit „call“ eine andere auf, der nicht gefolgt wird. Die andere Datei einfügen.",),
    "surface_file_type": ("Nicht unterstützter Dateityp. Unterstützte Dateien mit Flächen: {suffixes}.",),
    "file_without_surfaces": ("Die Datei hat keine B-Spline-Flächen. Flächen exportieren, oder ein Netz importieren.",),
    "no_surface_kept": ("Keine Fläche der Datei kann übernommen werden: {causes}",),
    "too_many_surfaces": ("Die Datei setzt mehr als {limit} Flächen. Weniger auf einmal exportieren.",),
    "too_many_control_points": (
        "Die Flächen der Datei brauchen mehr als {limit} Kontrollpunkte. Weniger auf einmal exportieren.",
    ),
    "surface_trimmed": (
        "Nicht importiert, weil sie beschnitten ist: {kind} {names}. Die Beschneidung aufheben, oder ein Netz "
        "exportieren.",
        "Nicht importiert, weil sie beschnitten sind: {count} der Art {kind}: {names}. Die Beschneidung aufheben, oder "
        "ein Netz exportieren.",
    ),
    "surface_type_unsupported": (
        "Nicht importiert, weil Blenders Flächen das nicht sein können: {kind} {names}. In eine B-Spline-Fläche "
        "umwandeln, oder ein Netz exportieren.",
        "Nicht importiert, weil Blenders Flächen das nicht sein können: {count} der Art {kind}: {names}. In "
        "B-Spline-Flächen umwandeln, oder ein Netz exportieren.",
    ),
    "surface_of_unsupported": (
        "Nicht importiert, weil Blenders Flächen nicht „{base}“ sein können: {kind} {names}. In eine B-Spline-Fläche "
        "umwandeln, oder ein Netz exportieren.",
        "Nicht importiert, weil Blenders Flächen nicht „{base}“ sein können: {count} der Art {kind}: {names}. In "
        "B-Spline-Flächen umwandeln, oder ein Netz exportieren.",
    ),
    "surface_order": (
        "Nicht importiert, weil die Ordnung {order} ist und {limit} die höchste: {kind} {names}. Den Grad senken, oder "
        "ein Netz exportieren.",
        "Nicht importiert, weil die Ordnung {order} ist und {limit} die höchste: {count} der Art {kind}: {names}. Den "
        "Grad senken, oder ein Netz exportieren.",
    ),
    "surface_too_large": (
        "Nicht importiert, weil {points} Kontrollpunkte nötig sind und {limit} die Grenze ist: {kind} {names}. Teilen.",
        "Nicht importiert, weil je {points} Kontrollpunkte nötig sind und {limit} die Grenze ist: {count} der Art "
        "{kind}: {names}. Teilen.",
    ),
    "surface_points": (
        "Nicht importiert: {kind} {names}. {cause}",
        "Nicht importiert: {count} der Art {kind}: {names}. {cause}",
    ),
    "surface_damaged": (
        "Nicht importiert, weil Zahlen fehlen oder unmöglich sind: {kind} {names}. Neu exportieren.",
        "Nicht importiert, weil Zahlen fehlen oder unmöglich sind: {count} der Art {kind}: {names}. Neu exportieren.",
    ),
    "surface_recursive": (
        "Nicht importiert, weil es sich auf sich selbst bezieht, oder zu tief: {kind} {names}. Neu exportieren.",
        "Nicht importiert, weil sie sich auf sich selbst beziehen, oder zu tief: {count} der Art {kind}: {names}. Neu "
        "exportieren.",
    ),
    "surface_flattened": (
        "Nicht importiert, weil die Transformation flach macht: {kind} {names}. Neu exportieren.",
        "Nicht importiert, weil Transformationen flach machen: {count} der Art {kind}: {names}. Neu exportieren.",
    ),
    "surfaces_hidden": (
        "{count} verborgene Fläche wurde weggelassen.",
        "{count} verborgene Flächen wurden weggelassen.",
    ),
    "curves_left_out": (
        "{count} Kurve oder Punkt, die nichts begrenzt, wurde weggelassen.",
        "{count} Kurven und Punkte, die nichts begrenzen, wurden weggelassen.",
    ),
    "surfaces_imported": (
        "{count} Fläche der Ordnung {order} aus {file} importiert.",
        "{count} Flächen bis zur Ordnung {order} aus {file} importiert.",
    ),
    "surfaces_rounded": (
        "Blender speichert Kontrollpunkte als 32-Bit-Zahlen: Punkte der Flächen wurden um bis zu {share:percent} der "
        "Größe verschoben.",
    ),
    "not_imported": ("Nicht importiert: {cause}",),
    "no_surface_file": ("Keine Datei gewählt. IGES- oder .obj-Dateien wählen.",),
}
