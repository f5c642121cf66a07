# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German. Menus of Blender are named as Blender's own German does."""

# Texts of the interface, as they stand in the source → German
TEXTS = {
    # verdict
    "Not Measured": "Nicht gemessen",
    "Not Measured Again": "Nicht neu gemessen",
    "Out of date: {:s}": "Veraltet: {:s}",
    "NURBS: {:s}": "NURBS: {:s}",
    "Grid: {:s}": "Raster: {:s}",
    "Exact": "Exakt",
    "The surface is closed": "Die Oberfläche ist geschlossen",
    "Exact, from a Grid": "Exakt, aus einem Raster",
    "Voxel values are taken as they are": "Die Werte der Voxel gelten, wie sie sind",
    "Reoriented": "Neu orientiert",
    "Closed after flipped faces were reversed": "Geschlossen, nachdem verdrehte Flächen umgedreht wurden",
    "Capped": "Mit Deckeln",
    "The surface is open; its holes were capped": "Die Oberfläche ist offen; ihre Löcher wurden geschlossen",
    "Open": "Offen",
    "The numbers depend on the reference point": "Die Zahlen hängen vom Bezugspunkt ab",
    "Shell": "Schale",
    "The mass is in the surface": "Die Masse liegt in der Oberfläche",
    "Wall": "Wand",
    "The mass is in a wall of real thickness": "Die Masse liegt in einer Wand von echter Dicke",
    "Union": "Vereinigung",
    "Overlapping components were united by Blender's exact Boolean, accurate to 7 digits": (
        "Überlappende Komponenten wurden mit Blenders exaktem Boolean vereinigt, auf 7 Stellen genau"
    ),
    "Wire": "Draht",
    "The mass is along the curve": "Die Masse liegt entlang der Kurve",
    "Warnings ({:d})": "Warnungen ({:d})",
    "Notes ({:d})": "Hinweise ({:d})",
    "Given": "Vorgegeben",
    "The mass is given; there is no geometry": "Die Masse ist vorgegeben; es gibt keine Geometrie",
    "Assembly": "Baugruppe",
    "The members as one body": "Die Teile als ein Körper",
    "Measure Assembly": "Baugruppe messen",
    "Members": "Teile",
    "Given Center": "Vorgegebener Mittelpunkt",
    "Given Inertia": "Vorgegebene Trägheit",
    # settings
    "Kind": "Art",
    "Solid": "Massiv",
    "Overlaps": "Überlappungen",
    "Count Each Shell": "Jede Schale zählen",
    "Count as Union": "Als Vereinigung zählen",
    "Specify": "Vorgeben",
    "Density From": "Dichte aus",
    "One Value": "Ein Wert",
    "Vertex Attribute": "Punktattribut",
    "Volume Object": "Volumenobjekt",
    "Density (kg/m³)": "Dichte (kg/m³)",
    "Mass (kg)": "Masse (kg)",
    "Order": "Ordnung",
    "About": "Bezogen auf",
    "Frame Origin": "Ursprung des Bezugssystems",
    "Center": "Mittelpunkt",
    "Center, Normalized": "Mittelpunkt, normiert",
    # overlay
    "Mass Properties": "Masseeigenschaften",
    "All Measured Objects": "Alle gemessenen Objekte",
    "Drop Line": "Lotlinie",
    "Equal Inertia": "Gleiche Trägheit",
    "Box": "Quader",
    "Ellipsoid": "Ellipsoid",
    "Sum of Selection": "Summe der Auswahl",
    "Faults": "Fehler",
    "Support Polygon": "Standfläche",
    "Path of Balance Groups": "Bahn der Balancegruppen",
    # stability
    "Balance Group": "Balancegruppe",
    "Balance Group...": "Balancegruppe...",
    "Contact Objects": "Kontaktobjekte",
    "Ground Height": "Höhe des Bodens",
    "Contact Distance": "Kontaktabstand",
    "Scene Range": "Bereich der Szene",
    "Stability": "Standfestigkeit",
    "Check Stability": "Standfestigkeit prüfen",
    "Rest on Ground": "Auf den Boden legen",
    "Stands": "Steht",
    "Tips Over": "Kippt",
    "Tips at": "Kippt bei",
    "Margin": "Abstand zur Kante",
    "Toward": "Richtung",
    "Resting Poses": "Ruhelagen",
    "Pose": "Lage",
    "Ground": "Boden",
    "Lowest Point": "Tiefster Punkt",
    "Pose {:d} of {:d}: {:.1f}%, tips at {:.1f}°": "Lage {:d} von {:d}: {:.1f}%, kippt bei {:.1f}°",
    "{:d} more": "{:d} weitere",
    # numbers and buttons
    "Area": "Fläche",
    "Center of Mass": "Massenmittelpunkt",
    "Principal Moments": "Hauptträgheitsmomente",
    "Principal Axes": "Hauptträgheitsachsen",
    "Radii of Gyration": "Trägheitsradien",
    "Inertia Tensor": "Trägheitstensor",
    "Error Bounds": "Fehlerschranken",
    "Apply to Object": "Auf Objekt anwenden",
    "Inertia": "Trägheit",
    "Selection": "Auswahl",
    "Advanced": "Erweitert",
    "Body Moments": "Körpermomente",
    "Center of Mass (World)": "Massenmittelpunkt (Welt)",
    "Center of Mass (Object)": "Massenmittelpunkt (Objekt)",
    "Total of Selection": "Summe der Auswahl",
    "1 Object": "1 Objekt",
    "{:d} Objects": "{:d} Objekte",
    "Measure": "Messen",
    "Select Defects": "Fehlerstellen auswählen",
    "Copy Report": "Bericht kopieren",
    "Clear Results": "Ergebnisse löschen",
    "Moments": "Momente",
    "Section": "Querschnitt",
    "Measure Section": "Querschnitt messen",
    # words that messages are filled with
    "inward": "nach innen",
    "outward": "nach außen",
    "centered": "mittig",
    "object": "Objekt",
    "world": "Welt",
}

# Codes of messages → German, and for several where the English has such a text
MESSAGES = {
    "progress_balance": ("Massenmittelpunkt wird verfolgt: {share:percent}. Esc zum Abbrechen",),
    "canceled_balance": ("Abgebrochen: nichts wurde geändert",),
    "objects_tip": ("{names} kippt um", "{names} kippen um"),
    "laid_on_ground": ("{count} Objekt auf den Boden gelegt", "{count} Objekte auf den Boden gelegt"),
    "panel_stability_unknown": ("Die Standfestigkeit wurde nicht berechnet.",),
    "panel_stability_stale": ("Die Geometrie hat sich geändert. Prüfen Sie noch einmal.",),
    "and_more": ("und {count} weitere",),
    "no_faces": ("Keine Flächen. Flächen hinzufügen oder ein anderes Objekt auswählen.",),
    "no_geometry": ("Keine Geometrie. Flächen hinzufügen oder prüfen, ob ein Modifikator sie entfernt.",),
    "no_volume": (
        "Die Flächen umschließen kein Volumen. Art auf Schale setzen, das Netz schließen oder für einen ebenen Umriss "
        "Querschnitt messen verwenden.",
    ),
    "vertices_welded": (
        "Offene Kanten wurden verschweißt: Punkte um bis zu {share:percent} der Größe bewegt. Masche > Zusammenführen "
        "> Nach Abstand verwenden.",
    ),
    "vertices_welded_slightly": (
        "Offene Kanten wurden verschweißt: Punkte um bis zu {share:percent} der Größe bewegt.",
    ),
    "duplicate_faces_ignored": (
        "Doppelte Fläche weggelassen: {elements}. Sie löschen.",
        "{count} doppelte Flächen weggelassen: {elements}. Sie löschen.",
    ),
    "t_junctions": (
        "{count} Spalt ohne Fläche (T-Stoß) gilt als geschlossen.",
        "{count} Spalte ohne Fläche (T-Stöße) gelten als geschlossen.",
    ),
    "flipped_faces": (
        "Verdrehte Fläche umgedreht gemessen: {elements}. Masche > Normalen > Äußeres neu berechnen verwenden.",
        "{count} verdrehte Flächen umgedreht gemessen: {elements}. Masche > Normalen > Äußeres neu berechnen "
        "verwenden.",
    ),
    "inverted_components": (
        "Umgestülpte Komponenten umgedreht gemessen: {count} von {total}. Masche > Normalen > Äußeres neu berechnen "
        "verwenden.",
    ),
    "holes_capped": (
        "Löcher geschlossen: {count} ({flat} eben, {curved} gekrümmt; {share:percent} der Fläche). Masche > Aufräumen "
        "> Löcher füllen verwenden.",
    ),
    "holes_capped_slightly": ("Löcher geschlossen: {count} ({share:percent} der Fläche).",),
    "one_sided_components": (
        "Einseitige Komponenten lassen sich nicht schließen: {count} von {total}. Volumen, Massenmittelpunkt und "
        "Trägheit hängen vom Bezugspunkt ab. Art auf Schale setzen.",
    ),
    "surface_not_closed": (
        "Die Oberfläche schließt sich nicht, und ihr Volumen hängt vom Bezugspunkt ab. Die Momente des Körpers "
        "nehmen, den measure_solid daraus macht.",
    ),
    "non_manifold_components": (
        "Komponenten lassen sich nicht schließen, wo mehr als zwei Flächen an einer Kante liegen: {count} von {total}. "
        "Volumen, Massenmittelpunkt und Trägheit hängen vom Bezugspunkt ab. Innere Flächen löschen und Löcher füllen "
        "oder Art auf Schale setzen.",
    ),
    "cavities_subtracted": (
        "{count} Hohlraum wurde abgezogen: eine nach innen gewandte Komponente in einer anderen.",
        "{count} Hohlräume wurden abgezogen: nach innen gewandte Komponenten in anderen.",
    ),
    "cavities_break_through": (
        "{count} Hohlraum durchbricht seine Wand, um bis zu {share:percent} der Größe; was außerhalb liegt, zählt "
        "negativ. Den Hohlraum verkleinern oder die Wand verstärken.",
        "{count} Hohlräume durchbrechen ihre Wände, um bis zu {share:percent} der Größe; was außerhalb liegt, zählt "
        "negativ. Die Hohlräume verkleinern oder die Wände verstärken.",
    ),
    "components_nested": (
        "{count} nach außen gewandte Komponente liegt in einer anderen; der gemeinsame Raum zählt doppelt. Hohlräume "
        "umdrehen oder Überlappungen auf Als Vereinigung zählen setzen.",
        "{count} nach außen gewandte Komponenten liegen in anderen; der gemeinsame Raum zählt doppelt. Hohlräume "
        "umdrehen oder Überlappungen auf Als Vereinigung zählen setzen.",
    ),
    "components_overlap": (
        "{count} Komponenten überlappen sich; der gemeinsame Raum zählt doppelt. Überlappungen auf Als Vereinigung "
        "zählen setzen.",
    ),
    "flat_surface": ("Die Oberfläche ist eben und umschließt kein Volumen. Art auf Schale setzen.",),
    "self_intersection": (
        "Die Oberfläche durchdringt sich: etwa {share:percent} des Volumens zählen doppelt oder negativ. Überlappungen "
        "auf Als Vereinigung zählen setzen oder das Mesh reparieren.",
    ),
    "self_intersection_slightly": (
        "Die Oberfläche durchdringt sich: etwa {share:percent} des Volumens zählen doppelt oder negativ.",
    ),
    "self_intersection_unchecked": ("Ob sich die Oberfläche durchdringt, wurde nicht geprüft.",),
    "self_intersecting": (
        "Die Oberfläche durchdringt sich, und Bereiche zählen negativ. Überlappungen auf Als Vereinigung zählen setzen "
        "oder das Netz reparieren.",
    ),
    "negative_inertia": (
        "Die Oberfläche durchdringt sich oder lässt sich nicht schließen, und Bereiche zählen negativ. Überlappungen "
        "auf Als Vereinigung zählen setzen, das Netz reparieren oder Art auf Schale setzen.",
    ),
    "non_planar_faces": (
        "Nicht ebene Flächen: ihre Zerlegung in Dreiecke kann das Volumen um bis zu {share:percent} ändern. Fläche > "
        "Dreieckige Flächen verwenden.",
    ),
    "non_planar_faces_slightly": (
        "Nicht ebene Flächen: ihre Zerlegung in Dreiecke kann das Volumen um bis zu {share:percent} ändern.",
    ),
    "union_by_boolean": (
        "Überlappende Komponenten wurden mit Blenders exaktem Boolean vereinigt, auf 7 Stellen genau.",
    ),
    "zero_scale": (
        "Eine Skalierung von null drückt das Objekt flach. Seine Skalierung und die seiner Eltern setzen oder Art auf "
        "Schale setzen.",
    ),
    "hidden_in_viewport": ("Im Ansichtsfenster ausgeblendet. Das Augensymbol im Outliner einschalten.",),
    "hidden_object_measured": ("Gemessen, obwohl nicht gezeigt: {cause}",),
    "edit_mode_modifiers": ("Im Bearbeitungsmodus mit den Modifikatoren gelesen: {modifiers}.",),
    "edit_mode_mesh": ("Vom Netz im Bearbeitungsmodus gelesen.",),
    "surface_drawn_as_polygons": (
        "Die Oberfläche wurde als gezeichnete Polygone gemessen. Doppelte Auflösung viertelt den Fehler.",
    ),
    "curves_drawn_as_polygons": (
        "Die Kurven wurden als gezeichnete Polygone gemessen. Doppelte Auflösung viertelt den Fehler.",
    ),
    "lines_only_curve": (
        "Linien ohne Oberfläche. Abschrägung oder Extrusion hinzufügen, die Kurve füllen oder Art auf Draht setzen.",
    ),
    "wall_measured": ("Die Wand wurde mit echter Dicke gemessen: {thickness:length}, {side:word}, Ecken auf Gehrung.",),
    "walls_overlap": (
        "Die Wände überlappen sich; der gemeinsame Raum zählt doppelt. Dicke verringern oder Wand ändern.",
    ),
    "density_defaulted": ("Keine Dichte gesetzt: 1000 kg/m³ verwendet. Dichte oder ein Material setzen.",),
    "zero_density": ("Die Dichte ist null. Dichte setzen.",),
    "axes_all_free": ("Alle Hauptträgheitsmomente sind gleich; die Achsen des Objekts gelten.",),
    "linked_results": ("Aus einer anderen Datei verknüpft. Lokal machen, um Ergebnisse zu speichern.",),
    "assembly_without_members": (
        "Nichts in der Baugruppe hat eine Masse. Messbare Objekte hinzufügen oder ihre Masse vorgeben.",
    ),
    "members_not_measured": (
        "{count} Teil ist nicht messbar und fehlt in der Summe: {names}. Einzeln messen, um den Grund zu sehen.",
        "{count} Teile sind nicht messbar und fehlen in der Summe: {names}. Einzeln messen, um den Grund zu sehen.",
    ),
    "members_excluded": (
        "{count} Teil ist ausgeschlossen und fehlt in der Summe: {names}. Im Outliner einschalten.",
        "{count} Teile sind ausgeschlossen und fehlen in der Summe: {names}. Im Outliner einschalten.",
    ),
    "members_density_unset": (
        "{count} Teil hat weder Dichte noch Masse und zählt mit der Vorgabe: {names}. Dichte setzen.",
        "{count} Teile haben weder Dichte noch Masse und zählen mit der Vorgabe: {names}. Dichte setzen.",
    ),
    "stale_settings": ("Einstellungen geändert",),
    "stale_geometry": ("Geometrie geändert",),
    "stale_transform": ("Transformation geändert",),
    "measured_one": ("{object} gemessen",),
    "measured_one_with_warnings": ("{object} gemessen, mit Warnungen",),
    "measured_several": ("{count} von {total} Objekten gemessen",),
    "panel_live": ("Live ({milliseconds:.0f} ms). Zum Speichern Messen drücken",),
}
