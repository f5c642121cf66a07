# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German messages about objects, instances, curves and NURBS surfaces."""

# Codes of messages → German, and for several where the English has such a text
MESSAGES = {
    "zero_scale": (
        "Eine Skalierung von null drückt das Objekt flach. Seine Skalierung und die seiner Eltern setzen oder Art "
        "auf Schale setzen.",
    ),
    "all_instances_zero_scale": (
        "Eine Skalierung von null drückt alle Instanzen flach. Ihre Skalierung setzen oder Art auf Schale setzen.",
    ),
    "instances_zero_scale": (
        "{count} Instanz ist durch eine Skalierung von null flach und umschließt nichts.",
        "{count} Instanzen sind durch eine Skalierung von null flach und umschließen nichts.",
    ),
    "instances_vanished": (
        "Weggelassen: {count} auf null skalierte Instanz.",
        "Weggelassen: {count} auf null skalierte Instanzen.",
    ),
    "no_visible_instances": ("Alle Instanzen sind auf null skaliert. Ihre Skalierung setzen.",),
    "instance_overlap_unchecked": (
        "Überlappung wurde zwischen {count} Instanzen nicht geprüft, deren umschließende Quader sich überlappen. "
        "Objekt > Anwenden > Instanzen real machen verwenden und sie verbinden.",
    ),
    "flat_instance_sources": (
        "{count} von {total} Oberflächen ist eben: ihre Fläche zählt, ihr Volumen nicht.",
        "{count} von {total} Oberflächen sind eben: ihre Flächen zählen, ihre Volumen nicht.",
    ),
    "flat_instance_sources_slightly": (
        "{count} von {total} Oberflächen ist eben und hat kein Volumen.",
        "{count} von {total} Oberflächen sind eben und haben kein Volumen.",
    ),
    "non_finite_instances": (
        "{count} von {total} Transformationen der Instanzen ist nicht endlich. Berichtigen, was NaN oder Unendlich "
        "erzeugt.",
        "{count} von {total} Transformationen der Instanzen sind nicht endlich. Berichtigen, was NaN oder Unendlich "
        "erzeugt.",
    ),
    "instances_of_hidden_object": (
        "Blender erzeugt keine Instanzen eines versteckten Objekts. Es im Ansichtsfenster zeigen.",
    ),
    "instanced_object_unreadable": ("Das instanzierte Objekt „{object}“ lässt sich nicht lesen: {cause}",),
    "instanced_by_parent": ("Nur als Instanzen von „{parent}“ gezeigt; einmal gemessen, an seinem eigenen Ort.",),
    "only_volume_instances": ("Nur Instanzen von Volumen werden gezeigt. Die Volumenobjekte messen.",),
    "instances_beside_volume": ("Weggelassen: Instanzen, die neben dem Volumen gezeigt werden.",),
    "empty_without_instances": (
        "Das Empty instanziert nichts. In Objekteigenschaften > Instanzieren eine Sammlung wählen.",
    ),
    "collection_without_surface": (
        "Die instanzierte Sammlung zeigt keine Oberfläche. Ein Objekt mit Flächen hinzufügen oder zeigen.",
    ),
    "instancer_hidden": (
        "Die eigene Geometrie des Objekts wird nicht gezeigt. In den Objekteigenschaften Instanzierer zeigen "
        "einschalten.",
    ),
    "not_in_scene": ("Nicht in der Szene „{scene}“. Das Objekt mit einer Sammlung der Szene verknüpfen.",),
    "disabled_in_viewports": ("In Ansichtsfenstern ausgeschaltet. Das Bildschirmsymbol im Outliner einschalten.",),
    "collection_excluded": (
        "Die Sammlung „{collection}“ ist von der Ansichtsebene ausgenommen. Sie im Outliner einschalten.",
    ),
    "collection_disabled": (
        "Die Sammlung „{collection}“ ist in Ansichtsfenstern ausgeschaltet. Ihr Bildschirmsymbol im Outliner "
        "einschalten.",
    ),
    "collection_hidden": ("Die Sammlung „{collection}“ ist versteckt. Ihr Augensymbol im Outliner einschalten.",),
    "hidden_in_viewport": ("Im Ansichtsfenster ausgeblendet. Das Augensymbol im Outliner einschalten.",),
    "not_evaluated": ("Blender hat das Objekt nicht ausgewertet. Die Ansichtsebene aktualisieren.",),
    "hidden_object_measured": ("Gemessen, obwohl nicht gezeigt: {cause}",),
    "object_without_geometry": (
        "Objekte vom Typ {type} haben keine Geometrie. Ein Objekt mit einer Oberfläche auswählen.",
    ),
    "non_finite_transform": (
        "Die Transformation ist nicht endlich. Position, Rotation und Skalierung zurücksetzen, auch die der Eltern.",
    ),
    "not_rendered": ("Nicht gerendert. Das Kamerasymbol im Outliner einschalten oder --all verwenden.",),
    "boolean_operand": ("Nur ein Operand von Boolean-Modifikatoren. --all verwenden, um es zu messen.",),
    "edit_mode_modifiers": ("Im Bearbeitungsmodus mit den Modifikatoren gelesen: {modifiers}.",),
    "edit_mode_shape_keys": ("Im Bearbeitungsmodus mit Formschlüsseln gelesen.",),
    "edit_mode_mesh": ("Vom Netz im Bearbeitungsmodus gelesen.",),
    "edit_mode_single_shape_key": (
        "Nur der bearbeitete Formschlüssel „{shape_key}“ wurde gelesen. Den Bearbeitungsmodus verlassen, um alle zu "
        "mischen.",
    ),
    "edit_mode_modifiers_off": (
        "Modifikatoren, die im Bearbeitungsmodus aus sind, wurden weggelassen: {modifiers}. Den Bearbeitungsmodus "
        "verlassen.",
    ),
    "sculpt_mode_modifiers": ("Im Skulpturmodus mit den Modifikatoren gelesen, die dort wirken.",),
    "dynamic_topology": ("Das mit Dyntopo geformte Netz lässt sich nicht lesen. Den Skulpturmodus verlassen.",),
    "sculpted_multires": (
        "Die mit „{modifier}“ geformten Stufen lassen sich nicht lesen. Den Skulpturmodus verlassen.",
    ),
    "modifier_error": ("Der Modifikator „{modifier}“ meldet einen Fehler: {error}",),
    "render_differs": ("Wie im Ansichtsfenster gemessen; gerendert ist anders: {differences}.",),
    "render_only_members": ("Weggelassen, da nur gerendert gezeigt: {objects}.",),
    "viewport_only_members": ("Gemessen, obwohl nicht gerendert: {objects}.",),
    "render_modifier_off": ("„{modifier}“ wird nicht gerendert",),
    "render_modifier_only": ("„{modifier}“ wird nur gerendert",),
    "render_levels_differ": ("„{modifier}“ hat {viewport} im Ansichtsfenster und {render} gerendert",),
    "render_particles_differ": ("„{modifier}“ zeigt {share:percent} seiner Partikel",),
    "render_resolution_differs": ("die Auflösung ist {viewport:.3g} im Ansichtsfenster und {render:.3g} gerendert",),
    "render_resolution_u_differs": ("Auflösung U ist {viewport} im Ansichtsfenster und {render} gerendert",),
    "render_resolution_v_differs": ("Auflösung V ist {viewport} im Ansichtsfenster und {render} gerendert",),
    "no_surface": ("Keine Oberfläche. Eine hinzufügen, etwa mit einem Modifikator.",),
    "only_without_surface": ("Keine Oberfläche, nur {kinds}. Eine Oberfläche hinzufügen, etwa mit einem Modifikator.",),
    "only_loose_geometry": (
        "Keine Flächen, nur {vertices} Punkte und {edges} Kanten. Flächen füllen oder mit einem Modifikator Dicke "
        "geben.",
    ),
    "surfaceless_left_out": ("Weggelassen, da ohne Oberfläche: {kinds}.",),
    "lines_only_curve": (
        "Linien ohne Oberfläche. Abschrägung oder Extrusion hinzufügen, die Kurve füllen oder Art auf Draht setzen.",
    ),
    "lines_only_text": ("Linien ohne Oberfläche. Abrundung oder Extrusion hinzufügen oder den Text füllen.",),
    "lines_only_surface": (
        "Linien ohne Oberfläche. Sie im Bearbeitungsmodus extrudieren oder ein Kurvenobjekt verwenden.",
    ),
    "splines_without_surface": (
        "Kein Spline hat eine Oberfläche: zu wenige Punkte für die Ordnung oder für Bézier-Enden. Punkte "
        "hinzufügen, Ordnung senken oder Bézier in Aktiver Spline ausschalten.",
    ),
    "empty_text": ("Der Text ist leer. Einen Text eingeben.",),
    "metaball_of_family": ("„{object}“ hält die Polygone dieser Metaball-Familie. Dieses Objekt messen.",),
    "metaball_family": ("Hält die Polygone seiner Metaball-Familie: {objects}.",),
    "kind_curves": ("{count} Kurve ohne Dicke", "{count} Kurven ohne Dicke"),
    "kind_points": ("{count} Punkt", "{count} Punkte"),
    "kind_volumes": ("{count} Volumen", "{count} Volumen"),
    "kind_metaballs": (
        "{count} Metaball, den Blender nicht instanzieren kann",
        "{count} Metabälle, die Blender nicht instanzieren kann",
    ),
    "surface_drawn_as_polygons": (
        "Die Oberfläche wurde als gezeichnete Polygone gemessen. Doppelte Auflösung viertelt den Fehler.",
    ),
    "curves_drawn_as_polygons": (
        "Die Kurven wurden als gezeichnete Polygone gemessen. Doppelte Auflösung viertelt den Fehler.",
    ),
    "curve_not_filled": ("Die Kurve ist nicht gefüllt; gemessen wurde das ebene Gebiet, das sie begrenzt.",),
    "curve_fill_measured": ("Blenders Füllung der Kurven wurde gemessen, überlappend oder nicht: {cause}",),
    "curve_fill_for_density": (
        "Blenders Füllung der Kurve wurde gemessen, da eine veränderliche Dichte Polygone braucht.",
    ),
    "curve_before_modifiers": ("Die Kurve wurde ohne die Modifikatoren gemessen, die auf ihr Netz wirken.",),
    "bevel_range_ignored": ("Die ganze Kurve wurde gemessen; Anfang und Ende ihrer Abrundung zählen nicht.",),
    "splines_left_out": (
        "{count} von {total} Splines ist weggelassen: zu wenige Punkte für seine Ordnung oder für Bézier-Enden.",
        "{count} von {total} Splines sind weggelassen: zu wenige Punkte für ihre Ordnung oder für Bézier-Enden.",
    ),
    "no_curve": ("Kein Spline ist eine Kurve. Punkte hinzufügen.",),
    "unknown_knots": (
        "Blender gibt die importierten Knoten nicht her. In Aktiver Spline Endpunkt aus- und einschalten, um "
        "bekannte zu erzeugen.",
    ),
    "only_curves_are_wires": ("Nur Kurven können Drähte sein. Art auf Massiv oder Schale setzen.",),
    "no_length": ("Die Kurve hat keine Länge. Ihre Punkte auseinanderbewegen.",),
    "non_finite_control_points": (
        "Einige Kontrollpunkte haben keine endlichen Koordinaten. Sie löschen oder den Modifikator oder Treiber "
        "berichtigen, der sie bewegt.",
    ),
    "shape_keys_of_other_points": (
        "Die Formschlüssel wurden für eine andere Zahl von Punkten angelegt. Sie entfernen oder rückgängig machen, was "
        "Punkte hinzugefügt oder entfernt hat.",
    ),
    "non_positive_weights": (
        "Einige Kontrollpunkte haben Gewichte, die nicht positiv sind. Ihre Gewichte über null setzen.",
    ),
    "curve_open": (
        "Eine Kurve ist offen und begrenzt kein Gebiet. Sie mit Zyklisch umschalten schließen oder Art auf Draht "
        "setzen.",
    ),
    "curves_not_coplanar": (
        "Die Kurven liegen nicht in einer Ebene und begrenzen kein ebenes Gebiet. Sie eben machen oder Art auf "
        "Draht setzen.",
    ),
    "curve_too_small": (
        "Eine Kurve ist kleiner als die Rundung ihrer Koordinaten. Sie löschen, näher an den Ursprung bewegen oder "
        "Art auf Draht setzen.",
    ),
    "curves_cross": (
        "Die Kurven kreuzen oder berühren sich, das Gebiet ist also mehrdeutig. Sie trennen oder Art auf Draht setzen.",
    ),
    "no_patches": ("Keine NURBS-Stücke. Eine Oberfläche mit genügend Punkten hinzufügen.",),
    "no_extent": ("Alle Kontrollpunkte fallen zusammen. Sie auseinanderbewegen.",),
    "discontinuous_patch": (
        "Ein Stück kann an einem Knoten unstetig sein, der so oft wiederholt ist, wie seine Ordnung sagt. Das Stück "
        "dort teilen.",
    ),
    "area_error_estimate_large": ("Der geschätzte Fehler der Fläche liegt über dem Ziel.",),
    "volume_error_estimate_large": (
        "Der geschätzte Fehler des Volumens liegt wegen extremer Gewichte über der Rundung.",
    ),
    "wall_error_estimate_large": ("Der geschätzte Fehler des Wandvolumens liegt über dem Ziel.",),
    "flipped_patches": (
        "{count} Stück liegt andersherum als die anderen und wurde umgedreht gemessen. Segmente > Richtung wechseln "
        "verwenden.",
        "{count} Stücke liegen andersherum als die anderen und wurden umgedreht gemessen. Segmente > Richtung "
        "wechseln verwenden.",
    ),
    "flipped_patches_slightly": (
        "{count} Stück liegt andersherum als die anderen und wurde umgedreht gemessen.",
        "{count} Stücke liegen andersherum als die anderen und wurden umgedreht gemessen.",
    ),
    "ambiguous_patch_sides": (
        "{count} Seite eines Stücks trifft mehr als eine andere, die Orientierung ist also geraten. Alle Stücke "
        "nach außen wenden.",
        "{count} Seiten von Stücken treffen mehr als eine andere, die Orientierung ist also geraten. Alle Stücke "
        "nach außen wenden.",
    ),
    "inverted_patch_components": (
        "Umgestülpte Komponenten umgedreht gemessen: {count} von {total}. Segmente > Richtung wechseln verwenden.",
    ),
    "inverted_patch_components_slightly": ("Umgestülpte Komponenten umgedreht gemessen: {count} von {total}.",),
    "open_patch_sides": (
        "Offene Seiten von Stücken bilden keine Schleifen, die sich schließen ließen, oder die Oberfläche ist "
        "einseitig. Volumen, Massenmittelpunkt und Trägheit hängen vom Bezugspunkt ab. Die Oberfläche schließen "
        "oder Art auf Schale setzen.",
    ),
    "flat_patch_holes_capped": (
        "Ebene Löcher exakt geschlossen: {count} ({share:percent} der Fläche). Die Oberfläche schließen.",
    ),
    "flat_patch_holes_capped_slightly": ("Ebene Löcher exakt geschlossen: {count} ({share:percent} der Fläche).",),
    "curved_patch_holes_capped": (
        "Unebene Löcher mit einem Kegel geschlossen: {count} ({out_of_plane:percent} der Größe aus der Ebene, "
        "{share:percent} der Fläche). Die Oberfläche schließen.",
    ),
    "curved_patch_holes_capped_slightly": (
        "Unebene Löcher mit einem Kegel geschlossen: {count} ({share:percent} der Fläche).",
    ),
    "patch_boundary_crosses_itself": (
        "{count} Rand kreuzt sich selbst; das Gebiet jenseits der Kreuzung zählt negativ.",
        "{count} Ränder kreuzen sich selbst; die Gebiete jenseits der Kreuzungen zählen negativ.",
    ),
    "control_points_recovered": (
        "Kontrollpunkte wurden aus dem Anzeigenetz gewonnen, auf 6 Stellen genau, da Modifikatoren oder Schlüssel "
        "sie bewegen.",
    ),
    "display_mesh_for_density": (
        "Das Anzeigenetz wurde gemessen, da eine veränderliche Dichte Polygone braucht. Für Genauigkeit die "
        "Vorschauauflösung erhöhen.",
    ),
    "display_mesh_for_modifiers": (
        "Das Anzeigenetz wurde gemessen, da Modifikatoren darauf wirken: {modifiers}. Für Genauigkeit die "
        "Vorschauauflösung erhöhen.",
    ),
    "display_mesh_for_weights": (
        "Das Anzeigenetz wurde gemessen, da {count} Kontrollpunkt kein positives Gewicht hat. Das Gewicht über null "
        "setzen.",
        "Das Anzeigenetz wurde gemessen, da {count} Kontrollpunkte keine positiven Gewichte haben. Die Gewichte "
        "über null setzen.",
    ),
    "display_mesh_measured": ("Das Anzeigenetz wurde gemessen. Für Genauigkeit die Vorschauauflösung erhöhen.",),
}
