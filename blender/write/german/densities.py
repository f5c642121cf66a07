# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German messages about walls, densities and grids."""

# Codes of messages → German, and for several where the English has such a text
MESSAGES = {
    "no_thickness": ("Die Schale hat keine Dicke. Dicke setzen.",),
    "wall_measured": ("Die Wand wurde mit echter Dicke gemessen: {thickness:length}, {side:word}, Ecken auf Gehrung.",),
    "wall_unoriented": (
        "Die Oberfläche ist nicht geschlossen; „nach innen“ ist hinter ihren Flächen, wie sie sind. Masche > "
        "Normalen > Umdrehen verwenden, um die Seite zu wechseln.",
    ),
    "wall_faces_reversed": ("Flächen wurden nach außen gedreht. Masche > Normalen > Äußeres neu berechnen verwenden.",),
    "wall_thickness_varies": (
        "An Ecken von mehr als drei Ebenen ist die Wand {minimum:.3g}- bis {maximum:.3g}-mal so dick.",
    ),
    "wall_thickness_varies_slightly": (
        "An Ecken von mehr als drei Ebenen ist die Wand {minimum:.6g}- bis {maximum:.6g}-mal so dick.",
    ),
    "wall_faces_without_area": (
        "{count} Fläche ohne Inhalt wurde mit ihren Nachbarn bewegt.",
        "{count} Flächen ohne Inhalt wurden mit ihren Nachbarn bewegt.",
    ),
    "wall_overlap_unchecked": ("Überlappung der Wände wurde bei dieser Dicke nicht geprüft. Messen drücken.",),
    "walls_overlap": (
        "Die Wände überlappen sich; der gemeinsame Raum zählt doppelt. Dicke verringern oder Wand ändern.",
    ),
    "instance_walls_unchecked": (
        "Überlappung zwischen den Wänden von Instanzen wurde nicht geprüft. Objekt > Anwenden > Instanzen real "
        "machen verwenden und sie verbinden.",
    ),
    "wall_folds": (
        "Eine Wand von {thickness:length} ({side:word}) faltet sich nahe {point:point} über sich selbst; die "
        "dickste mögliche ist {largest:length}. Dicke verringern, Wand ändern oder Wand auf Dünn setzen.",
    ),
    "wall_folds_somewhere": (
        "Eine Wand von {thickness:length} ({side:word}) faltet sich über sich selbst; die dickste mögliche ist "
        "{largest:length}. Dicke verringern, Wand ändern oder Wand auf Dünn setzen.",
    ),
    "wall_faces_fold_back": (
        "Flächen falten sich nahe {point:point} auf ihre Nachbarn zurück und lassen keinen Platz für eine Wand. Sie "
        "reparieren, Wand ändern oder auf Dünn setzen.",
    ),
    "wall_faces_fold_back_somewhere": (
        "Flächen falten sich auf ihre Nachbarn zurück und lassen keinen Platz für eine Wand. Sie reparieren, Wand "
        "ändern oder auf Dünn setzen.",
    ),
    "wall_non_manifold": (
        "{count} Kante hat mehr als zwei Flächen. Die Teile trennen oder Wand auf Dünn setzen.",
        "{count} Kanten haben mehr als zwei Flächen. Die Teile trennen oder Wand auf Dünn setzen.",
    ),
    "wall_inconsistent_faces": (
        "{count} Kante verbindet Flächen mit entgegengesetzten Normalen. Masche > Normalen > Äußeres neu berechnen "
        "verwenden oder Wand auf Dünn setzen.",
        "{count} Kanten verbinden Flächen mit entgegengesetzten Normalen. Masche > Normalen > Äußeres neu berechnen "
        "verwenden oder Wand auf Dünn setzen.",
    ),
    "wall_precision_lost": (
        "{share:percent} der Fläche liegt in Flächen, die so weit vom Ursprung zu klein sind, um in float32 eine "
        "Richtung zu haben. Näher am Ursprung modellieren oder Wand auf Dünn setzen.",
    ),
    "wall_needs_one_density": (
        "Eine Wand von echter Dicke braucht eine einzige Dichte. Dichte aus auf Ein Wert oder Wand auf Dünn setzen.",
    ),
    "wall_order": (
        "Von einer Wand von echter Dicke sind Momente über Ordnung {order} und Flächenmomente nicht bekannt. Wand "
        "auf Dünn setzen.",
    ),
    "wall_of_mixed_surfaces": ("Wände von NURBS-Flächen und Netzen zusammen gibt es nicht. Wand auf Dünn setzen.",),
    "wall_thicker_than_curvature": ("Die Wand ist dicker als der Krümmungsradius ihrer Oberfläche. Dicke verringern.",),
    "wall_creases": (
        "An Knicken von bis zu {angle:.0f}° überlappt oder klafft die Wand, da sie dort nicht auf Gehrung ist. "
        "Objekt > Konvertieren > Netz verwenden.",
    ),
    "density_defaulted": ("Keine Dichte gesetzt: 1000 kg/m³ verwendet. Dichte oder ein Material setzen.",),
    "density_default_kept": ("Keine Dichte gesetzt: 1000 kg/m³ wurden verwendet. Dichte oder ein Material setzen.",),
    "linear_density_defaulted": ("Keine Dichte je Länge gesetzt: 1 kg/m wurde verwendet. Sie setzen.",),
    "linear_density_default_kept": ("Keine Dichte je Länge gesetzt: 1 kg/m wurde verwendet. Sie setzen.",),
    "zero_density": ("Die Dichte ist null. Dichte setzen.",),
    "zero_mass": ("Die Masse ist null. Masse setzen.",),
    "mass_overflow": ("Die Dichten sind zu groß. Sie senken.",),
    "density_volume_missing": ("Für die Dichte ist kein Volumenobjekt gewählt. Eines in Volumen wählen.",),
    "density_volume_unreadable": ("Die Dichte aus „{object}“ lässt sich nicht lesen: {cause}",),
    "density_attribute_missing": ("Für die Dichte ist kein Punktattribut genannt. Attribut setzen.",),
    "density_attribute_of_solid": (
        "Ein Punktattribut hält Dichten nur auf der Oberfläche. Art auf Schale setzen oder Dichte aus ändern.",
    ),
    "density_volume_of_shell": (
        "Ein Raster hält Dichten nur in einem massiven Körper. Art auf Massiv setzen oder Dichte aus ändern.",
    ),
    "attribute_missing": ("Kein Punktattribut „{attribute}“. Es anlegen oder Attribut ändern.",),
    "attribute_type": (
        "Das Attribut „{attribute}“ ist keine Gleitkommazahl je Punkt. In den Objektdateneigenschaften Attribut "
        "konvertieren verwenden.",
    ),
    "attribute_non_finite": (
        "Das Attribut „{attribute}“ ist an {count} Punkt nicht endlich: {elements}. Dort die Dichte setzen.",
        "Das Attribut „{attribute}“ ist an {count} Punkten nicht endlich: {elements}. Dort die Dichten setzen.",
    ),
    "attribute_negative": (
        "Das Attribut „{attribute}“ ist an {count} Punkt negativ: {elements}. Dort die Dichte setzen.",
        "Das Attribut „{attribute}“ ist an {count} Punkten negativ: {elements}. Dort die Dichten setzen.",
    ),
    "materials_of_union": (
        "Vereinigte Komponenten haben keine Materialien. Überlappungen auf Jede Schale zählen oder Dichte aus auf "
        "Ein Wert setzen.",
    ),
    "material_without_density": (
        "{count} von {total} Flächen hat kein Material mit einer Dichte, und Dichte ist null. Dichte setzen.",
        "{count} von {total} Flächen haben kein Material mit einer Dichte, und Dichte ist null. Dichte setzen.",
    ),
    "object_density_used": (
        "{count} von {total} Flächen hat kein Material mit einer Dichte und nimmt die des Objekts, {density:.7g} "
        "kg/m³.",
        "{count} von {total} Flächen haben kein Material mit einer Dichte und nehmen die des Objekts, {density:.7g} "
        "kg/m³.",
    ),
    "object_density_used_for_materials": (
        "{count} von {total} Flächen nimmt die Dichte des Objekts, {density:.7g} kg/m³, da diese Materialien keine "
        "haben: {materials}.",
        "{count} von {total} Flächen nehmen die Dichte des Objekts, {density:.7g} kg/m³, da diese Materialien keine "
        "haben: {materials}.",
    ),
    "mixed_material_component": (
        "Eine Komponente hat mehrere Materialien ({materials}) und nimmt ihr Mittel nach Fläche, {density:.7g} "
        "kg/m³. Masche > Trennen > Nach Material verwenden.",
    ),
    "mixed_material_components": (
        "{count} von {total} Komponenten haben mehrere Materialien und nehmen ihre Mittel nach Fläche. Masche > "
        "Trennen > Nach Material verwenden.",
    ),
    "mixed_materials_slightly": (
        "{count} von {total} Komponenten hat mehrere Materialien und nimmt ihr Mittel nach Fläche.",
        "{count} von {total} Komponenten haben mehrere Materialien und nehmen ihre Mittel nach Fläche.",
    ),
    "overlapping_densities": (
        "Dichten addieren sich, wo Komponenten sich überlappen. Für jeden Einsatz einen Hohlraum schneiden.",
    ),
    "cavity_material_ignored": (
        "Materialien an Flächen von Hohlräumen zählen nicht: ein Hohlraum nimmt das Material um ihn weg.",
    ),
    "cavity_material_ignored_slightly": ("Materialien an Flächen kleiner Hohlräume zählen nicht.",),
    "sheared_density_axes": (
        "Das Objekt ist geschert; seine Dichte folgt den nächsten rechtwinkligen Achsen. Objekt > Anwenden > "
        "Skalierung verwenden.",
    ),
    "density_of_united_instances": (
        "Vereinigte Instanzen haben keine Objektkoordinaten. Koordinaten auf Welt oder Überlappungen auf Jede "
        "Schale zählen setzen.",
    ),
    "density_possibly_negative": ("Die Dichte kann im Objekt negativ sein, obwohl kein geprüfter Punkt es zeigt.",),
    "density_negative": (
        "Die Dichte ist negativ: {density:.4g} kg/m³ bei {point:point} in Koordinaten: {frame:word}. Polynom oder "
        "Koordinaten ändern.",
    ),
    "density_from_value": ("ein Wert",),
    "density_from_mass": ("gegebene Masse",),
    "density_from_members": ("Mitglieder",),
    "density_from_samples": ("Abtastwerte",),
    "density_from_grid": ("Raster „{grid}“",),
    "density_from_grid_of": ("Raster „{grid}“ von „{object}“",),
    "density_from_polynomial": ("Polynom {polynomial}, Koordinaten: {frame:word}",),
    "density_from_coefficients": (
        "Polynom mit den Koeffizienten {polynomial} von 1, x, y, z, …, Koordinaten: {frame:word}",
    ),
    "density_from_attribute": ("Punktattribut „{attribute}“",),
    "density_from_materials": ("Materialien: {materials}",),
    "density_of_material": ("{material} {density:.7g} kg/m³",),
    "density_of_others": ("andere {density:.7g} kg/m³",),
    "density_mixed_by_area": ("gemischte Komponenten nach Fläche",),
    "polynomial_empty": ("Das Polynom ist leer. Eines eingeben, etwa 1000 + 20*z.",),
    "polynomial_too_long": ("Das Polynom ist länger als {limit} Zeichen. Es kürzen.",),
    "polynomial_syntax": ("Das Polynom lässt sich nicht lesen. Produkte mit * schreiben, wie in 20*z.",),
    "polynomial_syntax_at": (
        "Das Polynom lässt sich bei „{part}“ nicht lesen. Produkte mit * schreiben, wie in 20*z.",
    ),
    "polynomial_nested": ("Das Polynom ist zu tief geschachtelt oder hat ungültige Zeichen. Es vereinfachen.",),
    "polynomial_coefficients": ("Zu viele Koeffizienten: der Grad ist höchstens {limit}.",),
    "polynomial_number_too_large": ("„{part}“ ist eine zu große Zahl.",),
    "polynomial_unknown_name": ("„{part}“ ist nicht x, y oder z.",),
    "polynomial_not_allowed": (
        "„{part}“ ist in einem Polynom nicht erlaubt. Zahlen, x, y, z, +, -, *, Division durch eine Zahl, ganze "
        "Potenzen mit ** und Klammern verwenden.",
    ),
    "polynomial_caret": ("„{part}“ ist in einem Polynom nicht erlaubt. Potenzen mit ** schreiben.",),
    "polynomial_division_by_zero": ("„{part}“ teilt durch null.",),
    "polynomial_exponent": ("Der Exponent in „{part}“ muss eine ganze Zahl von 0 bis {limit} sein.",),
    "polynomial_degree": ("„{part}“ hat einen Grad über {limit}.",),
    "polynomial_not_constant": ("„{part}“ muss eine Zahl sein, ohne x, y und z.",),
    "polynomial_overflow": ("„{part}“ hat Koeffizienten außerhalb des Zahlenbereichs.",),
    "polynomial_beyond_numbers": (
        "Das Polynom hat am Objekt Werte außerhalb des Zahlenbereichs. Kleinere Koeffizienten verwenden oder das "
        "Objekt näher an den Ursprung bewegen.",
    ),
    "grid_density": ("Dichte aus dem Raster „{grid}“, {samples:size} Voxel. {cause}",),
    "grid_density_of": (
        "Dichte aus dem Raster „{grid}“ von „{object}“, in jedem Voxel konstant. {cause} Die Fehlerschranken der "
        "Masse sind Schätzungen.",
    ),
    "array_density": ("Dichte aus einem Feld von {samples:size} Abtastwerten. {cause}",),
    "values_scaled": ("Ein Wert von 1 steht für {density:.6g} kg/m³.",),
    "values_by_table": ("Werte werden durch die Übertragungstabelle zu Dichten.",),
    "values_scaled_spline": (
        "Ein Wert von 1 steht für {density:.6g} kg/m³; die Werte sind Spline-Koeffizienten der Ordnung {order}, die "
        "sie glättet.",
    ),
    "values_by_table_spline": (
        "Werte werden durch die Übertragungstabelle zu Dichten; sie sind Spline-Koeffizienten der Ordnung {order}, "
        "die sie glättet.",
    ),
    "grid_without_surface": (
        "Ein Raster hat keine Oberfläche: die Fläche ist 0, das Volumen das der Voxel, die nicht leer sind.",
    ),
    "background_empty": ("Voxel mit dem Hintergrundwert {value:.6g} zählen als leer.",),
    "level_set_measured": (
        "Die Niveaumenge „{grid}“ wurde als Körper aus {polygons} Polygonen gemessen, auf einen Bruchteil eines "
        "Voxels.",
    ),
    "grid_is_level_set": (
        "Das Raster „{grid}“ ist eine Niveaumenge von Abständen, nicht von Dichten. Messen als auf Massiv setzen "
        "oder es in ein Nebelvolumen umwandeln.",
    ),
    "density_grid_is_level_set": (
        "Das Raster „{grid}“ von „{object}“ ist eine Niveaumenge von Abständen, nicht von Dichten. Ein anderes "
        "Raster wählen.",
    ),
    "grid_is_not_level_set": ("Das Raster „{grid}“ ist keine Niveaumenge. Messen als auf Dichte setzen.",),
    "level_set_empty": ("Die Niveaumenge „{grid}“ umschließt kein Volumen. Ein anderes Raster wählen.",),
    "grid_empty": ("Das Raster hat keine Voxel mit Masse. Ein anderes Raster wählen oder Werte prüfen.",),
    "density_grid_empty": (
        "Das Raster „{grid}“ von „{object}“ ist leer oder flach. Ein anderes Raster wählen oder seine Skalierung "
        "setzen.",
    ),
    "density_grid_elsewhere": (
        "Das Raster „{grid}“ von „{object}“ hat im Objekt keine Dichte. Prüfen, wo beide sind.",
    ),
    "outside_grid": (
        "{share:percent} des Volumens liegt außerhalb des Rasters und zählt als leer. Das Raster vergrößern.",
    ),
    "outside_grid_slightly": ("{share:percent} des Volumens liegt außerhalb des Rasters und zählt als leer.",),
    "density_grid_too_fine": (
        "Das Raster „{grid}“ von „{object}“ hat um das Objekt zu viele Voxel, {samples:size}. Ein gröberes Raster "
        "verwenden.",
    ),
    "threshold_measured": (
        "Der Körper, in dem das Raster „{grid}“ mindestens {threshold} ist, nach seinem Interpolanten. Seine "
        "Oberfläche geht durch {cells} Zellen.",
    ),
    "threshold_clipped": (
        "Der Körper reicht bis an den Rand des Rasters „{grid}“ und ist dort abgeschnitten. Schwellwert erhöhen "
        "oder das Raster vergrößern.",
    ),
    "threshold_not_reached": (
        "Kein Wert des Rasters „{grid}“ erreicht den Schwellwert {threshold}; der größte ist {largest}. Schwellwert "
        "senken.",
    ),
    "threshold_needs_factor": (
        "Innerhalb eines Schwellwerts werden Werte nur mit einem Faktor zu Dichten. Werte auf Faktor setzen oder "
        "Gefüllt mit auf Material.",
    ),
    "threshold_too_large": (
        "Das Raster „{grid}“ umfasst zu viele Voxel, {samples}, für einen Schwellwert. Neu abtasten oder zuschneiden.",
    ),
    "grid_as_shell": ("Ein Raster aus Voxeln kann keine Schale sein. Art auf Massiv setzen.",),
    "open_surface_of_grid": (
        "Die Oberfläche ist offen, das Innere des Rasters also nicht bestimmt. Das Netz schließen.",
    ),
    "object_without_grid": ("Das Volumenobjekt zeigt kein Raster. Ein anderes wählen.",),
    "volume_without_grids": (
        "Das Volumen hat keine Raster. Eine Datei wählen oder einen Modifikator hinzufügen, der Raster erzeugt.",
    ),
    "volume_file_unreadable": ("Die Datei des Volumens lässt sich nicht lesen: {error}. Eine andere Datei wählen.",),
    "volume_file_missing": ("Die Datei des Volumens fehlt oder ist beschädigt. Eine andere Datei wählen.",),
    "grid_missing": ("Kein Raster „{grid}“; das Volumen hat {grids}. Raster ändern.",),
    "grid_type": ("Das Raster „{grid}“ hält keine einzelnen Zahlen. Ein anderes Raster wählen.",),
    "grid_value_type": ("Das Raster „{grid}“ hält Werte vom Typ {type}, keine Dichten. Ein anderes Raster wählen.",),
    "no_scalar_grid": ("Kein Raster hält einzelne Zahlen; das Volumen hat {grids}. Ein anderes Volumen wählen.",),
    "grid_unreadable": ("Das Raster „{grid}“ lässt sich nicht lesen: {error}.",),
    "grid_frustum": (
        "Das Raster „{grid}“ hat eine Pyramidenstumpf-Transformation. Es mit einer linearen Transformation neu "
        "abtasten.",
    ),
    "grid_too_sparse": (
        "Das Raster „{grid}“ erstreckt sich über zu viele Voxel, {samples:size}. Entfernte Voxel löschen.",
    ),
    "grid_far_from_origin": (
        "Die Voxelindizes des Rasters „{grid}“ sind zu weit von null. Seinen Ursprung näher legen.",
    ),
    "grid_transform_singular": (
        "Die Transformation des Rasters ist singulär oder nicht endlich. Seine Skalierung setzen.",
    ),
    "grid_names_repeated": ("Mehrere Raster haben denselben Namen; nur das erste zählt. Die anderen umbenennen.",),
    "grids_left_out": ("Das Raster „{grid}“ wurde gemessen; weggelassen: {grids}.",),
    "grid_simplified": (
        "Vereinfachen verringert die Voxel auf {share:percent} ihrer Auflösung. In den Rendereigenschaften "
        "Vereinfachen ausschalten.",
    ),
    "grid_needs_openvdb": (
        "Das Raster „{grid}“ lässt sich nur mit dem Modul openvdb lesen, das diesem Blender fehlt. Es in "
        "Gleitkommazahlen umwandeln.",
    ),
    "grid_too_large_without_openvdb": (
        "Das Raster „{grid}“ hat zu viele Voxel, {samples:size}, um ohne das Modul openvdb gelesen zu werden.",
    ),
    "level_set_needs_openvdb": (
        "Niveaumengen lassen sich ohne das Modul openvdb nicht erkennen. Einen Knoten Raster zu Netz hinzufügen und "
        "das Netz messen.",
    ),
    "grid_not_sampled": ("Das Raster „{grid}“ lässt sich nicht abtasten.",),
    "temporary_folder_full": ("Voxel lassen sich nicht in den temporären Ordner schreiben. Speicherplatz freimachen.",),
    "density_non_finite": (
        "Die Dichten sind nicht endlich oder zu groß, um summiert zu werden. Solche Werte entfernen.",
    ),
    "values_non_finite_for_table": (
        "Einige Werte sind nicht endlich und haben keine Dichte in der Übertragungstabelle. Sie entfernen.",
    ),
    "values_negative": (
        "Negative Dichten, bis zu {density:.6g} kg/m³. Werte auf Tabelle oder für eine Niveaumenge Messen als auf "
        "Massiv setzen.",
    ),
    "array_negative": (
        "Negative Dichten, bis zu {density:.6g} kg/m³. Die Abtastwerte in Dichten umwandeln oder Datei > "
        "Importieren > Scan von Dichten verwenden.",
    ),
    "transfer_table_syntax": (
        "„{part}“ ist kein Paar der Übertragungstabelle: ein Wert und eine Dichte in kg/m³, mit Kommas zwischen "
        "Paaren.",
    ),
    "transfer_table_too_short": (
        "Die Übertragungstabelle braucht mindestens zwei Paare aus einem Wert und einer Dichte.",
    ),
    "transfer_table_numbers": ("Die Übertragungstabelle hat negative Dichten oder Zahlen, die nicht endlich sind.",),
    "transfer_table_order": ("Die Werte der Übertragungstabelle müssen aufsteigen.",),
}
