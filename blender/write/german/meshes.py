# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German messages about meshes."""

# Codes of messages → German, and for several where the English has such a text
MESSAGES = {
    "no_faces": ("Keine Flächen. Flächen hinzufügen oder ein anderes Objekt auswählen.",),
    "no_geometry": ("Keine Geometrie. Flächen hinzufügen oder prüfen, ob ein Modifikator sie entfernt.",),
    "no_face_area": (
        "Alle Flächen haben den Inhalt null. Ihre Punkte auseinanderbewegen oder ein anderes Objekt auswählen.",
    ),
    "surface_not_closed": (
        "Die Oberfläche schließt sich nicht, und ihr Volumen hängt vom Bezugspunkt ab. Die Momente des Körpers "
        "nehmen, den measure_solid daraus macht.",
    ),
    "boundary_open": (
        "Die Facetten schließen sich nicht, und die Momente dessen, was sie umschließen, hängen vom Bezugspunkt ab. "
        "Die fehlenden hinzufügen oder die verkehrt gerichteten mit „signs“ umdrehen.",
    ),
    "no_volume": (
        "Die Flächen umschließen kein Volumen. Art auf Schale setzen, das Netz schließen oder für einen ebenen "
        "Umriss Querschnitt messen verwenden.",
    ),
    "no_certain_volume": ("Das Volumen ist innerhalb der Rundung null. Nach Punkten weit weg vom Objekt suchen.",),
    "invalid_faces": ("Flächen verwenden Punkte, die es nicht gibt. In der Python-Konsole mesh.validate() ausführen.",),
    "non_finite_vertices": (
        "{count} von {total} Punkten hat keine endlichen Koordinaten. Ihn löschen oder den Modifikator, Treiber "
        "oder Import berichtigen, der ihn erzeugt hat.",
        "{count} von {total} Punkten haben keine endlichen Koordinaten. Sie löschen oder den Modifikator, Treiber "
        "oder Import berichtigen, der sie erzeugt hat.",
    ),
    "object_too_large": ("Zu groß, um gemessen zu werden. Das Objekt verkleinern.",),
    "object_too_small": ("Zu klein, um gemessen zu werden. Das Objekt vergrößern.",),
    "moments_overflow": (
        "Momente der Ordnung {order} übersteigen den Zahlenbereich. Das Objekt skalieren oder eine niedrigere "
        "Ordnung wählen.",
    ),
    "moments_overflow_at_origin": (
        "Um diesen Ursprung übersteigen Momente der Ordnung {order} den Zahlenbereich. Bezogen auf: Mittelpunkt "
        "wählen.",
    ),
    "mass_moments_unknown": (
        "Für dieses Objekt sind Momente der Masse nicht bis zur Ordnung {order} verfügbar. Ordnung auf 3 setzen oder "
        "Bereich auf Volumen.",
    ),
    "moments_of_flat": ("Eine ebene Form hat kein Volumen. Bereich auf Fläche setzen.",),
    "invariants_of_flat": ("Invarianten sind die ebener Formen. Bereich auf Fläche setzen.",),
    "invariants_order": ("Invarianten brauchen Ordnung {order}. Ordnung setzen und die Momente berechnen.",),
    "normalization_undefined": (
        "Die Momente lassen sich nicht normieren: Volumen oder Fläche ist null. Bezogen auf: Mittelpunkt wählen.",
    ),
    "vertices_welded": (
        "Offene Kanten wurden verschweißt: Punkte um bis zu {share:percent} der Größe bewegt. Masche > "
        "Zusammenführen > Nach Abstand verwenden.",
    ),
    "vertices_welded_slightly": (
        "Offene Kanten wurden verschweißt: Punkte um bis zu {share:percent} der Größe bewegt.",
    ),
    "duplicate_faces_ignored": (
        "Doppelte Fläche weggelassen: {elements}. Sie löschen.",
        "{count} doppelte Flächen weggelassen: {elements}. Sie löschen.",
    ),
    "duplicate_faces_ignored_slightly": (
        "Doppelte Fläche weggelassen: {elements}.",
        "{count} doppelte Flächen weggelassen: {elements}.",
    ),
    "duplicate_faces_counted": (
        "Doppelte Fläche zweimal gezählt: {elements}. Sie löschen.",
        "{count} doppelte Flächen zweimal gezählt: {elements}. Sie löschen.",
    ),
    "duplicate_faces_counted_slightly": (
        "Doppelte Fläche zweimal gezählt: {elements}.",
        "{count} doppelte Flächen zweimal gezählt: {elements}.",
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
    "flipped_faces_slightly": (
        "Verdrehte Fläche umgedreht gemessen: {elements}.",
        "{count} verdrehte Flächen umgedreht gemessen: {elements}.",
    ),
    "inverted_components": (
        "Umgestülpte Komponenten umgedreht gemessen: {count} von {total}. Masche > Normalen > Äußeres neu berechnen "
        "verwenden.",
    ),
    "inverted_components_slightly": ("Umgestülpte Komponenten umgedreht gemessen: {count} von {total}.",),
    "holes_capped": (
        "Löcher geschlossen: {count} ({flat} eben, {curved} gekrümmt; {share:percent} der Fläche). Masche > "
        "Aufräumen > Löcher füllen verwenden.",
    ),
    "holes_capped_slightly": ("Löcher geschlossen: {count} ({share:percent} der Fläche).",),
    "one_sided_components": (
        "Einseitige Komponenten lassen sich nicht schließen: {count} von {total}. Volumen, Massenmittelpunkt und "
        "Trägheit hängen vom Bezugspunkt ab. Art auf Schale setzen.",
    ),
    "non_manifold_components": (
        "Komponenten lassen sich nicht schließen, wo mehr als zwei Flächen an einer Kante liegen: {count} von "
        "{total}. Volumen, Massenmittelpunkt und Trägheit hängen vom Bezugspunkt ab. Innere Flächen löschen und "
        "Löcher füllen oder Art auf Schale setzen.",
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
    "cavities_break_through_slightly": (
        "{count} Hohlraum durchbricht seine Wand, um bis zu {share:percent} der Größe.",
        "{count} Hohlräume durchbrechen ihre Wände, um bis zu {share:percent} der Größe.",
    ),
    "components_nested": (
        "{count} nach außen gewandte Komponente liegt in einer anderen; der gemeinsame Raum zählt doppelt. "
        "Hohlräume umdrehen oder Überlappungen auf Als Vereinigung zählen setzen.",
        "{count} nach außen gewandte Komponenten liegen in anderen; der gemeinsame Raum zählt doppelt. Hohlräume "
        "umdrehen oder Überlappungen auf Als Vereinigung zählen setzen.",
    ),
    "components_nested_slightly": (
        "{count} nach außen gewandte Komponente liegt in einer anderen; der gemeinsame Raum zählt doppelt.",
        "{count} nach außen gewandte Komponenten liegen in anderen; der gemeinsame Raum zählt doppelt.",
    ),
    "components_overlap": (
        "{count} Komponenten überlappen sich; der gemeinsame Raum zählt doppelt. Überlappungen auf Als Vereinigung "
        "zählen setzen.",
    ),
    "components_overlap_slightly": ("{count} Komponenten überlappen sich; der gemeinsame Raum zählt doppelt.",),
    "overlap_unchecked": (
        "{count} Paar von Komponenten wurde nicht auf Überlappung geprüft, was zu lange dauern würde.",
        "{count} Paare von Komponenten wurden nicht auf Überlappung geprüft, was zu lange dauern würde.",
    ),
    "flat_components": (
        "{count} von {total} Komponenten ist eben und hat kein Volumen. Sie löschen oder Art auf Schale setzen.",
        "{count} von {total} Komponenten sind eben und haben kein Volumen. Sie löschen oder Art auf Schale setzen.",
    ),
    "flat_components_slightly": (
        "{count} von {total} Komponenten ist eben und hat kein Volumen.",
        "{count} von {total} Komponenten sind eben und haben kein Volumen.",
    ),
    "flat_surface": ("Die Oberfläche ist eben und umschließt kein Volumen. Art auf Schale setzen.",),
    "self_intersecting": (
        "Die Oberfläche durchdringt sich, und Bereiche zählen negativ. Überlappungen auf Als Vereinigung zählen "
        "setzen oder das Netz reparieren.",
    ),
    "self_intersection": (
        "Die Oberfläche durchdringt sich: etwa {share:percent} des Volumens zählen doppelt oder negativ. "
        "Überlappungen auf Als Vereinigung zählen setzen oder das Mesh reparieren.",
    ),
    "self_intersection_slightly": (
        "Die Oberfläche durchdringt sich: etwa {share:percent} des Volumens zählen doppelt oder negativ.",
    ),
    "self_intersection_unchecked": ("Ob sich die Oberfläche durchdringt, wurde nicht geprüft.",),
    "negative_inertia": (
        "Die Oberfläche durchdringt sich oder lässt sich nicht schließen, und Bereiche zählen negativ. "
        "Überlappungen auf Als Vereinigung zählen setzen, das Netz reparieren oder Art auf Schale setzen.",
    ),
    "non_planar_faces": (
        "Nicht ebene Flächen: ihre Zerlegung in Dreiecke kann das Volumen um bis zu {share:percent} ändern. Fläche "
        "> Dreieckige Flächen verwenden.",
    ),
    "non_planar_faces_slightly": (
        "Nicht ebene Flächen: ihre Zerlegung in Dreiecke kann das Volumen um bis zu {share:percent} ändern.",
    ),
    "non_planar_faces_of_display_mesh": (
        "Unebene Flächen des Anzeigenetzes: ihre Zerlegung in Dreiecke kann das Volumen um bis zu {share:percent} "
        "ändern.",
    ),
    "duplicate_faces_of_shell": (
        "{count} doppelte Fläche zählt als Material. Sie löschen.",
        "{count} doppelte Flächen zählen als Material. Sie löschen.",
    ),
    "duplicate_faces_of_shell_slightly": (
        "{count} doppelte Fläche zählt als Material.",
        "{count} doppelte Flächen zählen als Material.",
    ),
    "union_by_boolean": (
        "Überlappende Komponenten wurden mit Blenders exaktem Boolean vereinigt, auf 7 Stellen genau.",
    ),
    "union_failed": (
        "Blenders Boolean kann die Komponenten nicht vereinigen. Das Netz schließen und bereinigen oder "
        "Überlappungen auf Jede Schale zählen setzen.",
    ),
    "holes_capped_before_union": ("Vor dem Vereinigen wurden Löcher geschlossen ({share:percent} der Fläche).",),
    "holes_capped_before_union_slightly": (
        "Vor dem Vereinigen wurden Löcher geschlossen ({share:percent} der Fläche).",
    ),
    "faces_reversed_before_union": (
        "Vor dem Vereinigen wurden Flächen nach außen gedreht. Masche > Normalen > Äußeres neu berechnen verwenden.",
    ),
    "open_components_united": (
        "Offene Komponenten wurden vereinigt; das Ergebnis ist vielleicht nicht der gemeinte Körper. Das Netz "
        "schließen.",
    ),
    "union_of_display_mesh": (
        "Das Anzeigenetz wurde gemessen, da Vereinigen Polygone braucht. Die Vorschauauflösung erhöhen oder "
        "Überlappungen auf Jede Schale zählen setzen.",
    ),
}
