# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German messages about edited objects, totals, rigs and assemblies."""

# Codes of messages → German, and for several where the English has such a text
MESSAGES = {
    "linked_object": ("Aus einer anderen Datei verknüpft. Objekt > Beziehungen > Lokal machen verwenden.",),
    "linked_object_data": (
        "Aus einer anderen Datei verknüpft. Objekt > Beziehungen > Lokal machen für Objekt und Daten verwenden.",
    ),
    "library_override_settings": (
        "Eine Bibliotheksüberschreibung, die ihre Einstellungen verlöre. Objekt > Beziehungen > Lokal machen "
        "verwenden.",
    ),
    "library_override_symmetry": (
        "Eine Bibliotheksüberschreibung, die ihre Symmetrie verlöre. Objekt > Beziehungen > Lokal machen verwenden.",
    ),
    "library_override_mass": (
        "Eine Bibliotheksüberschreibung, die ihre Masse als Starrkörper verlöre. Objekt > Beziehungen > Lokal "
        "machen verwenden.",
    ),
    "open_object": (
        "Die Oberfläche ist offen und lässt sich nicht schließen, hat also keinen Massenmittelpunkt. Sie schließen "
        "oder Art auf Schale setzen.",
    ),
    "scale_zero_axis": ("Die Skalierung ist entlang einer Achse null. Skalierung setzen.",),
    "scale_zero_axis_of_parent_target": (
        "Die Skalierung ist entlang einer Achse null. Skalierung setzen oder An Objekt hängen ausschalten.",
    ),
    "parent_scale_zero": ("Das Elternobjekt hat die Skalierung null. Sie setzen.",),
    "parent_or_delta_scale_zero": (
        "Die Skalierung des Elternobjekts oder die Delta-Skalierung ist null. Sie zurücksetzen.",
    ),
    "parent_shears": ("Das Elternobjekt schert das Objekt. Das Elternobjekt lösen oder seine Skalierung anwenden.",),
    "channel_locked": ("Gesperrt: {channel:word}. In Objekteigenschaften > Transformation entsperren.",),
    "channel_animated": ("Animiert oder von einem Treiber gesetzt: {channel:word}. Die Animation entfernen.",),
    "location_constrained": (
        "Eine Beschränkung oder das Elternobjekt hält die Position. Sie anwenden oder entfernen.",
    ),
    "rotation_constrained": (
        "Eine Beschränkung oder das Elternobjekt hält Rotation oder Skalierung. Sie anwenden oder entfernen.",
    ),
    "collection_instance": (
        "Eine Sammlungsinstanz hat keine eigene Geometrie. Objekt > Anwenden > Instanzen real machen verwenden.",
    ),
    "volume_not_reframed": (
        "Die Voxel eines Volumens lassen sich im Objekt nicht bewegen. Empty hinzufügen oder Objekt an Welt "
        "ausrichten verwenden.",
    ),
    "data_without_transform": (
        "Geometrie dieses Typs lässt sich nicht transformieren. Objekt > Konvertieren > Netz verwenden.",
    ),
    "instances_on_own_geometry": (
        "Kinder werden auf seinen Punkten oder Flächen instanziert. Objekt > Anwenden > Instanzen real machen "
        "verwenden.",
    ),
    "render_only_modifier": (
        "Der Modifikator „{modifier}“ wird in Ansichtsfenstern nicht gezeigt und hängt vielleicht vom Ursprung ab. "
        "Ihn zeigen oder entfernen.",
    ),
    "density_in_object_coordinates": (
        "Das Dichtepolynom verwendet Objektkoordinaten, die sich ändern würden. Koordinaten auf Welt setzen.",
    ),
    "density_in_world_coordinates": (
        "Das Dichtepolynom verwendet Weltkoordinaten und bewegt sich nicht mit. Koordinaten auf Objekt setzen.",
    ),
    "bound_to_armature": (
        "An die Armatur „{armature}“ gebunden, die sich nicht mitbewegen würde. Die Armatur drehen oder ihren "
        "Modifikator anwenden.",
    ),
    "shape_depends_on_location": (
        "Die Form würde sich ändern, da sie durch {modifiers} von der Position abhängt. Sie anwenden.",
    ),
    "shape_depends_on_location_unknown": (
        "Die Form würde sich ändern, da sie von der Position abhängt. Objekt > Konvertieren > Netz verwenden.",
    ),
    "shape_depends_on_origin": (
        "Die Form würde sich ändern, da sie durch {modifiers} von Ursprung oder Achsen abhängt. Sie anwenden oder "
        "entfernen.",
    ),
    "shape_depends_on_origin_unknown": (
        "Die Form würde sich ändern. Die Skalierung anwenden oder Objekt > Konvertieren > Netz verwenden.",
    ),
    "text_off_plane": ("Text lässt sich nur in seiner eigenen Ebene bewegen. Objekt > Konvertieren > Netz verwenden.",),
    "child_linked": (
        "Das Kind „{object}“ ist aus einer anderen Datei verknüpft und lässt sich nicht an seinem Ort halten. Es "
        "lokal machen.",
    ),
    "child_not_held": (
        "Das Kind „{object}“ lässt sich nicht an seinem Ort halten. Dort Objekt > Überordnen > Elternobjekt lösen "
        "verwenden.",
    ),
    "dependent_shape_changes": (
        "„{object}“ würde seine Form ändern, da ein Modifikator sich auf dieses Objekt bezieht. Diesen Modifikator "
        "anwenden.",
    ),
    "dependent_curve_changes": (
        "„{object}“ würde seine Form ändern, da es dieses Objekt verwendet. Dort Objekt > Konvertieren > Netz "
        "verwenden.",
    ),
    "empty_followed": (
        "Das Objekt folgt seinem Empty „{empty}“ und würde sich mitbewegen. Dieses Elternobjekt oder diese "
        "Beschränkung lösen.",
    ),
    "empty_constrained": ("Eine Beschränkung hält das Empty „{empty}“. Sie entfernen.",),
    "data_copied": ("Die Daten wurden kopiert, da andere Objekte sie verwenden.",),
    "follower_moved": ("„{object}“ folgt durch eine Beschränkung und hat sich mitbewegt.",),
    "active_is_child": (
        "Das aktive Objekt ist ein Kind von diesem und würde sich mitbewegen. Das Elternobjekt lösen.",
    ),
    "not_a_rigid_body": ("Kein Starrkörper. Starrkörper hinzufügen einschalten.",),
    "rigid_body_needs_mesh": ("Nur Netze können Starrkörper sein. Objekt > Konvertieren > Netz verwenden.",),
    "rigid_body_mass_too_small": (
        "Die Masse {mass:.3g} kg liegt unter den {limit:.3g} kg eines Starrkörpers. Dichte erhöhen.",
    ),
    "rigid_body_display_scaled": (
        "Die Physikeigenschaften zeigen Massen mal {factor:.6g} (Einheitenmaßstab hoch drei); die Physik rechnet in "
        "Kilogramm.",
    ),
    "rigid_body_center_elsewhere": (
        "Die Physik nimmt den Ursprung als Massenmittelpunkt, der bei {objects} woanders liegt. Achsen auf "
        "Hauptachsen verwenden.",
    ),
    "balance_no_selection": ("Kein Punkt ausgewählt. Die Punkte auswählen, die sich bewegen dürfen.",),
    "balance_no_area": ("Kein beweglicher Punkt gehört zu einer Fläche mit Inhalt. Andere auswählen.",),
    "balance_zero_volume": ("Die Flächen umschließen kein Volumen. Das Netz schließen oder Art auf Schale setzen.",),
    "balance_no_effect": ("Diese Punkte zu bewegen kann den Massenmittelpunkt nicht dorthin bringen. Mehr auswählen.",),
    "balance_short": ("Dem Massenmittelpunkt fehlen {distance:length}. Mehr Punkte oder ein näheres Ziel wählen.",),
    "balance_short_by_limit": (
        "Mit dem Höchstabstand {limit:length} fehlen dem Massenmittelpunkt {distance:length}. Höchstabstand erhöhen "
        "oder mehr Punkte auswählen.",
    ),
    "balance_folds_faces": (
        "{count} Fläche würde umklappen. Mehr Punkte oder ein näheres Ziel wählen.",
        "{count} Flächen würden umklappen. Mehr Punkte oder ein näheres Ziel wählen.",
    ),
    "balance_no_group": ("Keine Punktgruppe „{group}“. Eine in Punktgruppe wählen.",),
    "balance_no_active_group": ("Keine Punktgruppe. Eine mit den Punkten hinzufügen, die sich bewegen dürfen.",),
    "balance_group_empty": (
        "Kein Punkt hat ein Gewicht in der Punktgruppe „{group}“. Die Punkte zuweisen, die sich bewegen dürfen.",
    ),
    "balance_triangulation_varies": (
        "Die Zerlegung in Dreiecke ändert sich mit jeder Bewegung. Fläche > Flächen triangulieren verwenden.",
    ),
    "balance_linked_mesh": ("Das Netz ist aus einer anderen Datei verknüpft. Es lokal machen.",),
    "balance_shape_keys": ("Das Netz hat Formschlüssel. Sie anwenden oder entfernen.",),
    "balance_wall": ("Ausbalancieren braucht eine dünne Schale. Wand auf Dünn setzen.",),
    "balance_varying_density": ("Ausbalancieren braucht gleichmäßige Dichte. Dichte aus auf Ein Wert setzen.",),
    "balance_unclean": (
        "Das Netz ist nicht geschlossen mit allen Flächen nach außen. Nach Abstand zusammenführen, Löcher füllen "
        "und Normalen neu berechnen oder Art auf Schale setzen.",
    ),
    "balance_zero_scale": ("Eine Skalierung von null drückt das Objekt flach. Skalierung setzen.",),
    "balance_instances": ("Das Objekt zeigt Instanzen. Objekt > Anwenden > Instanzen real machen verwenden.",),
    "balance_modified": ("Die gemessene Form entsteht durch {modifiers}. Sie anwenden oder verstecken.",),
    "balance_modified_unknown": (
        "Die gemessene Form entsteht durch Animation, Beschränkungen oder Instanzen. Sie anwenden.",
    ),
    "balance_mesh_shared": ("Andere Objekte verwenden dieses Netz und haben sich auch geändert.",),
    "balance_only_active": (
        "Nur „{object}“ wurde ausbalanciert; die anderen Netze im Bearbeitungsmodus sind unverändert.",
    ),
    "modified_mesh": (
        "Modifikatoren ändern das Netz, seine Fehlerstellen sind also nicht die des Gemessenen. {modifiers} "
        "anwenden oder verstecken.",
    ),
    "linked_results": ("Aus einer anderen Datei verknüpft. Lokal machen, um Ergebnisse zu speichern.",),
    "override_results": (
        "Eine Bibliotheksüberschreibung, die ihre Ergebnisse verlöre. Sie lokal machen, um Ergebnisse zu speichern.",
    ),
    "material_not_local": ("Kein lokales Material „{material}“. Es lokal machen.",),
    "orientation_needs_viewport": ("Eine Transformationsorientierung braucht ein offenes 3D-Ansichtsfenster.",),
    "total_boolean_operands": (
        "Operanden von Boolean-Modifikatoren zählen als Körper: {operands}. Weglassen, was kein Teil ist.",
    ),
    "total_hidden_objects": (
        "Objekte, die versteckt, nicht gerendert oder als Draht oder Grenzen angezeigt sind, zählen: {objects}. "
        "Weglassen, was kein Teil ist.",
    ),
    "total_of_open_objects": (
        "Die Summe hängt vom Bezugspunkt ab, da diese offen sind: {objects}. Sie schließen oder weglassen.",
    ),
    "no_active_armature": ("Das aktive Objekt ist keine Armatur. Eine auswählen.",),
    "armature_in_edit_mode": ("Die Armatur ist im Bearbeitungsmodus. Ihn verlassen.",),
    "no_deforming_bones": ("Kein Knochen verformt Netze. Die, die es tun, zu verformenden Knochen machen.",),
    "bone_missing": (
        "Seinen Elternknochen „{bone}“ gibt es nicht, daher fehlt es in der Summe. Einen anderen wählen.",
    ),
    "rig_without_parts": (
        "Die Armatur verformt kein messbares Netz, und nichts hängt an ihren Knochen. Dem Netz einen "
        "Armatur-Modifikator geben.",
    ),
    "bone_part_impossible": ("Kein Körper hat die Momente des Knochenteils: {cause} Gewichte und Normalen prüfen.",),
    "bone_parts_impossible": (
        "{count} Knochen hat einen Teil, dessen Momente kein Körper hat: {names}. Gewichte und Normalen prüfen.",
        "{count} Knochen haben Teile, deren Momente kein Körper hat: {names}. Gewichte und Normalen prüfen.",
    ),
    "unweighted_vertices": (
        "{count} von {total} Punkten hat kein Gewicht auf einem verformenden Knochen; Flächen nur mit solchen "
        "Punkten gehen mit dem nächsten Knochen. Gewichte zuweisen.",
        "{count} von {total} Punkten haben kein Gewicht auf einem verformenden Knochen; Flächen nur mit solchen "
        "Punkten gehen mit dem nächsten Knochen. Gewichte zuweisen.",
    ),
    "rig_open_mesh": (
        "Das Netz lässt sich nicht schließen; der Teil jedes Knochens wird an seinen eigenen Schnitten geschlossen. "
        "Das Netz reparieren.",
    ),
    "rig_wall_thin": ("Die Wand zählt als dünnes Blech: Fläche mal Dicke.",),
    "rig_mean_density": ("Die Dichte ist veränderlich; der Teil jedes Knochens hat die mittlere Dichte des Netzes.",),
    "bones_measured": (
        "{armature}: {mass:.7g} kg in den Teilen von {count} Knochen",
        "{armature}: {mass:.7g} kg in den Teilen von {count} Knochen",
    ),
    "physics_rig_created": ("Angelegte Starrkörper: {count}, Gelenke: {joints}",),
    "physics_rig_too_light": (
        "Starrkörper wiegen mindestens {limit:.3g} kg, und diese Teile weniger: {names}. Die Figur skalieren oder "
        "Massen setzen.",
    ),
    "rig_center_added": ("Den Massenmittelpunkt von „{armature}“ hinzugefügt, der seiner Pose folgt",),
    "stale_rig": ("Knochen, Einstellungen oder Objekte geändert",),
    "axis_points_coincide": ("Die zwei Punkte der Achse liegen zu nah beieinander. Einen bewegen.",),
    "axis_needs_two_points": ("{count} Punkte sind ausgewählt. Zwei Punkte oder zwei Objekte auswählen.",),
    "reference_object_missing": ("Kein Objekt als Bezug gewählt. Eines in Objekt wählen.",),
    "reference_stored": (
        "Die Trägheit von {count} Objekt um den Bezug gespeichert",
        "Die Trägheit von {count} Objekten um den Bezug gespeichert",
    ),
    "center_given": ("Der Massenmittelpunkt ist gegeben.",),
    "inertia_given": ("Die Trägheit ist gegeben.",),
    "given_inertia_impossible": (
        "Kein Körper hat die gegebene Trägheit: ihre Hauptmomente sind {moments}, und keines darf negativ oder "
        "größer als die Summe der anderen beiden sein. Vorzeichen und Einheiten prüfen.",
    ),
    "given_center_outside": ("Der gegebene Massenmittelpunkt liegt außerhalb des Objekts. Massenmittelpunkt prüfen.",),
    "given_center_missing": (
        "Die gegebene Masse liegt am Weltursprung, da kein Mitglied eine Masse hat. Gegebener Mittelpunkt einschalten.",
    ),
    "assembly_mass_given": ("Die Masse der Baugruppe ist gegeben: {mass:.7g} kg.",),
    "assembly_without_members": (
        "Nichts in der Baugruppe hat eine Masse. Messbare Objekte hinzufügen oder ihre Masse vorgeben.",
    ),
    "member_counted_before": ("Schon gezählt, in „{assembly}“.",),
    "members_not_measured": (
        "{count} Teil ist nicht messbar und fehlt in der Summe: {names}. Einzeln messen, um den Grund zu sehen.",
        "{count} Teile sind nicht messbar und fehlen in der Summe: {names}. Einzeln messen, um den Grund zu sehen.",
    ),
    "members_counted_before": (
        "{count} Mitglied ist mehr als einmal in der Baugruppe und zählt einmal: {names}.",
        "{count} Mitglieder sind mehr als einmal in der Baugruppe und zählen einmal: {names}.",
    ),
    "members_left_out": (
        "{count} Mitglied ist nicht gerendert oder nur ein Operand von Boolean-Modifikatoren und nicht in der "
        "Summe: {names}.",
        "{count} Mitglieder sind nicht gerendert oder nur Operanden von Boolean-Modifikatoren und nicht in der "
        "Summe: {names}.",
    ),
    "members_excluded": (
        "{count} Teil ist ausgeschlossen und fehlt in der Summe: {names}. Im Outliner einschalten.",
        "{count} Teile sind ausgeschlossen und fehlen in der Summe: {names}. Im Outliner einschalten.",
    ),
    "members_hidden": (
        "{count} Mitglied ist versteckt und zählt: {names}.",
        "{count} Mitglieder sind versteckt und zählen: {names}.",
    ),
    "members_density_unset": (
        "{count} Teil hat weder Dichte noch Masse und zählt mit der Vorgabe: {names}. Dichte setzen.",
        "{count} Teile haben weder Dichte noch Masse und zählen mit der Vorgabe: {names}. Dichte setzen.",
    ),
    "members_mass_given": (
        "{count} Baugruppe darin hat eine gegebene Masse: {names}.",
        "{count} Baugruppen darin haben eine gegebene Masse: {names}.",
    ),
    "members_not_stored": (
        "{count} Mitglied kann keine Ergebnisse halten: {names}.",
        "{count} Mitglieder können keine Ergebnisse halten: {names}.",
    ),
    "instance_without_scale": ("Die Instanz ist entlang einer Achse auf null skaliert. Ihre Skalierung setzen.",),
    "instance_stretches_sheets": (
        "Die Instanz streckt Schalen oder Drähte ungleichmäßig, ihre Masse hat also keinen einen Faktor. Ihr eine "
        "gleichmäßige Skalierung geben.",
    ),
    "no_active_collection": ("Keine Sammlung ist aktiv. Eine im Outliner anklicken.",),
    "no_active_assembly_empty": ("Das aktive Objekt ist kein Empty mit Kindern. Eines auswählen.",),
    "assembly_measured": (
        "{assembly}: {mass:.7g} kg aus {count} Objekt",
        "{assembly}: {mass:.7g} kg aus {count} Objekten",
    ),
    "assembly_has_open_members": (
        "Ein Mitglied ist offen, und sein Mittelpunkt hängt von einem Bezugspunkt ab. Sein Netz schließen oder Art "
        "auf Schale setzen.",
    ),
    "cursor_to_assembly": ("3D-Cursor auf den Massenmittelpunkt von „{assembly}“ bewegt",),
    "empty_at_assembly": ("Ein Empty in das Hauptachsensystem von „{assembly}“ gesetzt",),
    "assembly_offset_set": ("Instanzen von „{assembly}“ werden nach ihrem Massenmittelpunkt gesetzt",),
    "assembly_origin_moved": ("„{assembly}“ in den Massenmittelpunkt bewegt; seine Kinder bleiben",),
    "children_would_move": (
        "Diese würden sich mitbewegen: {names}. Entfernen, was sie hält, etwa Beschränkungen oder Animation.",
    ),
    "bill_written": (
        "Die Massen von {count} Mitglied in „{file}“ geschrieben",
        "Die Massen von {count} Mitgliedern in „{file}“ geschrieben",
    ),
    "no_export_file": ("Keine Datei genannt. Eine wählen.",),
    "file_not_written": ("Die Datei lässt sich nicht schreiben: {error}",),
}
