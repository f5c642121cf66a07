# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German messages about scans, axes, the Fourier transform, sections and files."""

# Codes of messages → German, and for several where the English has such a text
MESSAGES = {
    "file_damaged": ("Die Datei „{file}“ ist beschädigt: {cause}. Sie neu beschaffen oder neu exportieren.",),
    "damage_header": ("ihr Kopf hat weniger als {bytes} Byte",),
    "damage_lines": ("ihr fehlen die Zeilen, die ihr Kopf überspringt",),
    "damage_array": ("sie ist kein vollständiges NumPy-Feld",),
    "damage_arrays": ("sie ist kein vollständiges Archiv von NumPy-Feldern",),
    "damage_archive": ("sie ist kein vollständiges Archiv ({error})",),
    "damage_too_short": ("sie hält {bytes} der {total} Byte an Abtastwerten, die ihre Größen verlangen",),
    "damage_too_long": ("sie hält mehr als die {total} Byte an Abtastwerten, die ihre Größen verlangen",),
    "damage_too_small": ("{samples:size} Abtastwerte können nicht in sie komprimiert sein",),
    "damage_checksum": ("die Prüfsumme ihres komprimierten Teils ist falsch",),
    "damage_unpacked_length": ("die Länge ihres komprimierten Teils ist falsch",),
    "damage_packed_start": ("ihr komprimierter Teil oder was darauf folgt beginnt nicht wie gzip",),
    "damage_packed": ("ihr komprimierter Teil lässt sich nicht entpacken ({error})",),
    "damage_packed_end": ("ihr komprimierter Teil ist abgeschnitten",),
    "damage_ply_header": ("ihr Kopf ist nicht der einer PLY-Datei",),
    "damage_ply_rows": ("sie endet oder hat anderes als Zahlen vor dem Ende ihrer {count} Zeilen von „{name}“",),
    "damage_ply_index": ("eine Fläche hat einen Scheitelpunkt, der nicht unter ihren {vertices} ist",),
    "threshold_positions": (
        "Ein Schwellwert braucht Abtastwerte in gleichen Abständen. --positions weglassen oder den Scan neu abtasten.",
    ),
    "stl_size": ("Die STL-Datei ist abgeschnitten oder beschädigt: ihre Größe passt nicht zur Zahl ihrer Dreiecke.",),
    "stl_cut_short": ("Die STL-Datei ist abgeschnitten: „endsolid“ fehlt.",),
    "non_finite_coordinates": (
        "{count} Zahl in der Datei ist nicht endlich (NaN oder unendlich), bei {place}. Die Datei reparieren oder neu "
        "exportieren.",
        "{count} Zahlen in der Datei sind nicht endlich (NaN oder unendlich), die erste bei {place}. Die Datei "
        "reparieren oder neu exportieren.",
    ),
    "line_misread": ("Zeile {line} würde falsch gelesen: {cause}. Die Datei reparieren oder neu exportieren.",),
    "field_not_number": ("„{text}“ ist keine endliche Dezimalzahl",),
    "field_not_whole": ("„{text}“ ist keine ganze Zahl",),
    "field_not_vertex": ("„{text}“ verweist auf einen Scheitelpunkt, den es nicht gibt",),
    "field_not_word": ("„{text}“ steht anstelle von „{expected}“",),
    "field_count": ("„{text}“ hat zu wenige oder zu viele Zahlen",),
    "at_vertex": ("Scheitelpunkt {vertex}",),
    "at_triangle": ("Dreieck {triangle}",),
    "file_type": ("Nicht unterstützter Dateityp. Unterstützt: {suffixes}.",),
    "file_without_objects": ("Kein Objekt in der Datei. Prüfen, ob es eine {suffix}-Datei ist.",),
    "file_without_faces": ("Die Datei hat keine Flächen.",),
    "ply_concave_polygons": (
        "{count} Vieleck der PLY-Datei ist konkav. Es triangulieren oder mit --stream never importieren.",
        "{count} Vielecke der PLY-Datei sind konkav. Sie triangulieren oder mit --stream never importieren.",
    ),
    "mesh_streamed": (
        "{count} Fläche wurde blockweise gelesen, ohne Reparatur: nach Selbstdurchdringung, verschachtelten und "
        "umgestülpten Komponenten wurde nicht gesucht. --stream never verwenden, wo der Speicher reicht.",
        "{count} Flächen wurden blockweise gelesen, ohne Reparatur: nach Selbstdurchdringung, verschachtelten und "
        "umgestülpten Komponenten wurde nicht gesucht. --stream never verwenden, wo der Speicher reicht.",
    ),
    "streamed_open": (
        "Die Oberfläche ist nicht geschlossen, oder ihre Flächen widersprechen sich: das Volumen hängt vom Bezugspunkt "
        "ab. Das Netz reparieren oder --stream never verwenden.",
    ),
    "streamed_inside_out": ("Die Oberfläche ist als Ganzes umgestülpt und wurde umgedreht gemessen.",),
    "nrrd_skip_from_end": ("„byte skip: -1“ ist für rohe Abtastwerte; komprimierte werden von ihrem Anfang gezählt.",),
    "no_3d_array": ("Kein Feld in der Datei hat 3 Dimensionen.",),
    "arrays_left_out": ("Das Feld „{array}“ wurde gemessen; weggelassen: {arrays}.",),
    "raw_type_unknown": ("Unbekannter Typ der Abtastwerte „{type}“. Einen von {types} verwenden.",),
    "raw_without_layout": (
        "Eine rohe Datei beschreibt ihre Abtastwerte nicht. Sie NAME_XxYxZ_TYP.raw nennen, etwa "
        "head_128x128x54_uint16.raw, oder einen NRRD-Kopf hinzufügen.",
    ),
    "nifti_unrecognized": ("Keine NIfTI-1-Datei.",),
    "nifti_header_of_pair": (
        "Die Datei ist der Kopf eines Paars aus .hdr und .img. Es als eine .nii-Datei speichern.",
    ),
    "nifti_dimensions": ("Der NIfTI-Kopf gibt {dimensions} Dimensionen an.",),
    "nifti_type": ("Der NIfTI-Datentyp {type} ist keine unterstützte reelle Zahl.",),
    "nifti_type_size": ("Der NIfTI-Kopf widerspricht sich: {bits} Bit für Datentyp {type}.",),
    "nifti_offset": ("Der NIfTI-Kopf gibt einen unmöglichen Datenversatz an, {offset:g}.",),
    "nifti_spacing": ("Der NIfTI-Kopf gibt einen unmöglichen Abstand an, {x:g} x {y:g} x {z:g}.",),
    "nifti_rotation": ("Der NIfTI-Kopf gibt eine ungültige Drehung an.",),
    "samples_positioned": ("Die Abtastwerte stehen entlang {axes} an den angegebenen Stellen.",),
    "positions_missing": ("Die Datei der Stellen entlang {axis}, „{file}“, gibt es nicht.",),
    "positions_not_a_row": (
        "Die Stellen entlang {axis} in „{file}“ sind keine Reihe von Zahlen, sondern {dimensions} Dimensionen vom Typ "
        "{type}. Ein Feld mit einer Dimension speichern.",
    ),
    "positions_count": (
        "„{file}“ hat {count} Stellen entlang {axis}, und der Scan {samples} Abtastwerte. Für jeden eine speichern.",
    ),
    "positions_of_one_sample": (
        "Der Scan hat entlang {axis} einen Abtastwert; eine Stelle sagt nicht, wie dick er ist. „{file}“ weglassen.",
    ),
    "positions_non_finite": (
        "Stelle {place} entlang {axis} in „{file}“ ist nicht endlich; die erste ist Stelle 0. Sie berichtigen.",
    ),
    "positions_not_ascending": (
        "Stelle {place} entlang {axis} in „{file}“ ist nicht größer als die davor; die erste ist Stelle 0. Die Stellen "
        "ordnen, und die Abtastwerte mit ihnen.",
    ),
    "positions_of_other_samples": (
        "Das Gitter „{grid}“ hat Abtastwerte jenseits seiner {count} Stellen entlang {axis}. Den Scan neu importieren.",
    ),
    "positions_damaged": (
        "Die Stellen der Abtastwerte von „{grid}“ sind keine Reihen aufsteigender Zahlen. Den Scan neu importieren.",
    ),
    "positions_only_as_density": (
        "Die Abtastwerte des Gitters „{grid}“ stehen nicht gleichmäßig und können nur als Dichte gemessen werden. "
        "Messen als auf Dichte stellen, oder den Scan ohne Stellen importieren.",
    ),
    "scan_drawn_evenly": (
        "Blender zeichnet Abtastwerte gleichmäßig. Sie werden gemessen, wo sie stehen; die Enden entlang {axes} sind "
        "an ihrem Platz.",
    ),
    "nrrd_unrecognized": ("Keine NRRD-Datei (NRRD0001 bis NRRD0005).",),
    "nrrd_field_missing": ("Dem NRRD-Kopf fehlt das Feld „{field}“.",),
    "nrrd_field_not_numbers": ("Das NRRD-Feld „{field}“ ist keine Liste von Zahlen: {text:.60s}.",),
    "nrrd_field_not_one_number": ("Das NRRD-Feld „{field}“ muss eine einzige Zahl sein.",),
    "nrrd_dimension_mismatch": ("Die NRRD-Felder „dimension“ und „sizes“ widersprechen sich.",),
    "nrrd_type": ("Der NRRD-Typ „{type:.40s}“ ist keine reelle Zahl.",),
    "nrrd_endian_missing": ("Dem NRRD-Kopf fehlt die Bytereihenfolge (Feld „endian“).",),
    "nrrd_several_files": ("Die Abtastwerte sind über mehrere Dateien verteilt. Sie zu einer verbinden.",),
    "nrrd_data_file_missing": ("Die Datendatei „{file:.80s}“ fehlt.",),
    "nrrd_data_file_outside": (
        "Die Datendatei „{file:.80s}“ liegt außerhalb des Ordners des Kopfs. Sie dorthin bewegen oder, wenn man dem "
        "Kopf traut, Außerhalb erlauben einschalten oder --allow-outside verwenden.",
    ),
    "file_exceeds_limit": (
        "„{file}“ übersteigt eine Grenze: {count} {name} von höchstens {limit}. Wenn man der Datei traut, die "
        "Umgebungsvariable BODY_MOMENTS_LIMITS auf {name}={next} setzen.",
    ),
    "limits_unrecognized": (
        "Die Umgebungsvariable BODY_MOMENTS_LIMITS hat „{text}“, was keine Grenze ist. NAME=ZAHL verwenden, mit "
        "einem NAMEN aus {names}.",
    ),
    "nrrd_header_unended": ("Der NRRD-Kopf hat kein Ende: die leere Zeile vor den Abtastwerten fehlt.",),
    "nrrd_encoding": ("Die NRRD-Kodierung „{encoding:.40s}“ wird nicht unterstützt. Als raw oder gzip speichern.",),
    "nrrd_space_directions": ("Das NRRD-Feld „space directions“ muss drei Vektoren haben.",),
    "nrrd_spacings": ("Das NRRD-Feld „spacings“ muss drei Zahlen ungleich null haben.",),
    "nrrd_vector": ("Das NRRD-Feld „{field}“ hat einen Vektor, der nicht aus drei Zahlen besteht: {text:.60s}.",),
    "scan_dimensions": ("Die Datei hat {dimensions} Dimensionen; ein Scan hat 3. Ein Volumen daraus speichern.",),
    "scan_size": ("Die Größe des Scans ist unmöglich: {samples:size}.",),
    "scan_sample_type": ("Abtastwerte vom Typ {type} sind keine reellen Zahlen.",),
    "scan_empty": ("Der Scan hat keine Abtastwerte.",),
    "scan_file_type": ("Nicht unterstützter Dateityp. Unterstützte Scans: {suffixes}.",),
    "scan_out_of_memory": ("Die Abtastwerte passen nicht in den Speicher. Die Datei entpacken.",),
    "scan_placement": (
        "Der Kopf legt alle Abtastwerte in eine Ebene: ein Abstand oder eine Richtung ist null oder nicht endlich.",
    ),
    "scan_scaling": ("Der Kopf skaliert die Abtastwerte mit Zahlen, die nicht endlich sind.",),
    "scan_non_finite": ("Einige Abtastwerte sind nicht endlich. Sie entfernen.",),
    "scan_own_unit": (
        "Die Datei hat ihre eigene Einheit; der Einheitenmaßstab gilt nur für gegebenen Abstand und Ursprung.",
    ),
    "scan_placement_overridden": ("Gegebene Werte ersetzen die des Kopfs: {fields}.",),
    "scan_without_spacing": (
        "Die Datei hat keinen Abstand: 1 Einheit wurde angenommen. Abstand setzen oder --spacing verwenden.",
    ),
    "scan_without_unit": (
        "Die Datei hat keine Einheit: 1 Einheit gilt als 1 m. Abstand setzen oder --unit-scale verwenden.",
    ),
    "scan_ct_numbers": ("Negative Werte gelten nach der Übertragungstabelle als CT-Zahlen.",),
    "given_density_ignored": ("Die Abtastwerte sind Dichten; die gegebene Dichte wurde nicht verwendet.",),
    "axes_all_free": ("Alle Hauptträgheitsmomente sind gleich; die Achsen des Objekts gelten.",),
    "axes_2_3_free": (
        "Hauptträgheitsmomente 2 und 3 sind gleich; die den Objektachsen nächsten Richtungen werden verwendet.",
    ),
    "axes_1_2_free": (
        "Hauptträgheitsmomente 1 und 2 sind gleich; die den Objektachsen nächsten Richtungen werden verwendet.",
    ),
    "axes_ambiguous": (
        "Der Körper ist symmetrisch unter einer halben Drehung; die den Objektachsen nächsten Richtungen werden "
        "verwendet.",
    ),
    "axes_all_free_by_shape": (
        "Alle Hauptträgheitsmomente sind gleich; die den Objektachsen nächsten Achsen der Form werden verwendet.",
    ),
    "axes_2_3_free_by_shape": (
        "Hauptträgheitsmomente 2 und 3 sind gleich; die den Objektachsen nächsten Richtungen der Form werden "
        "verwendet.",
    ),
    "axes_1_2_free_by_shape": (
        "Hauptträgheitsmomente 1 und 2 sind gleich; die den Objektachsen nächsten Richtungen der Form werden "
        "verwendet.",
    ),
    "axes_from_third_order": (
        "Die Hauptträgheitsachsen verwenden nur Momente bis zur Ordnung 3, da das Netz viele Flächen hat; Auf "
        "Objekt anwenden und --pose verwenden höhere Ordnungen und können abweichen.",
    ),
    "strict_rule_equal_moments": (
        "Die Regel von Zhang und Chen ist bei gleichen Hauptträgheitsmomenten nicht bestimmt. Sie ausschalten.",
    ),
    "strict_rule_no_skewness": (
        "Die Regel von Zhang und Chen ist ohne Schiefe entlang der Achsen 1 und 2 nicht bestimmt. Sie ausschalten.",
    ),
    "shape_of_grid": ("Ein Raster von Dichten hat keine Form für Lage oder Signatur.",),
    "shape_of_wire_or_wall": (
        "Lage und Signatur gibt es für Drähte und Wände nicht. Wand auf Dünn setzen oder in ein Netz umwandeln.",
    ),
    "shape_of_open_surface": (
        "Lage und Signatur hängen vom Bezugspunkt ab, da die Oberfläche offen ist. Sie schließen oder Art auf "
        "Schale setzen.",
    ),
    "shape_far_from_origin": ("Zu weit vom Weltursprung für eine genaue Form. Das Objekt näher bewegen.",),
    "signature_needs_polygons": ("Die Signatur braucht Polygone. Objekt > Konvertieren > Netz verwenden.",),
    "mirror_image": ("Ein Spiegelbild des aktiven Objekts, das keine Drehung zur Deckung bringt.",),
    "flat_mirror_image": ("Ein Spiegelbild des aktiven Objekts, von vorn gesehen. Es umdrehen oder spiegeln.",),
    "flat_and_body": (
        "Eine ebene Form und ein Körper passen nicht aufeinander. Objekte einer Art auswählen oder Art auf "
        "Schale setzen.",
    ),
    "flat_of_type": ("Nur Meshes, 2D-Kurven und Texte können ebene Formen sein. Das Objekt in ein Mesh umwandeln.",),
    "fourier_of_wire": (
        "Die Fourier-Transformation eines Drahts gibt es nicht. Art auf Massiv oder Schale oder Bereich auf "
        "Oberfläche setzen.",
    ),
    "fourier_of_open_surface": (
        "Die Oberfläche ist offen und begrenzt keinen Körper. Sie schließen, Art auf Schale oder Bereich auf "
        "Oberfläche setzen.",
    ),
    "fourier_of_wall": (
        "Die Fourier-Transformation braucht eine dünne Schale. Wand auf Dünn oder Bereich auf Oberfläche setzen "
        "oder einen Verdicken-Modifikator anwenden.",
    ),
    "fourier_no_extent": ("Das Objekt hat keine Ausdehnung. Höchste Frequenz setzen.",),
    "fourier_approximate": (
        "Die schnelle Fourier-Transformation dieses Rasters ist auf {share:g} ihres Werts bei 0 genau. --q für die "
        "geschlossene Form verwenden.",
    ),
    "fourier_of_display_mesh": (
        "Die Fourier-Transformation ist die des Anzeigenetzes. Für Genauigkeit die Vorschauauflösung erhöhen.",
    ),
    "fourier_of_uniform_density": ("Die Fourier-Transformation ist die der Form, mit gleichmäßiger Dichte.",),
    "fourier_too_large": ("Zu groß für eine Fourier-Transformation. Das Objekt verkleinern.",),
    "fourier_too_small": ("Zu klein für eine Fourier-Transformation. Das Objekt vergrößern.",),
    "fourier_not_written": ("Die Fourier-Transformation lässt sich nicht schreiben: {error}.",),
    "fourier_folder_missing": ("Den Ordner „{folder}“ gibt es nicht. Einen anderen Dateipfad wählen.",),
    "fourier_path_missing": ("Keine Datei gewählt. Dateipfad setzen.",),
    "wave_vectors_shape": (
        "Wellenvektoren müssen Zeilen aus {dimension} reellen Zahlen sein; das Feld hat die Form {shape:size} und "
        "den Typ {type}.",
    ),
    "wave_vectors_non_finite": ("Einige Wellenvektoren sind nicht endlich.",),
    "wave_vectors_too_large": ("Einige Wellenvektoren übersteigen 1e100 rad/m.",),
    "frequency_range": ("Die höchste Frequenz muss positiv und höchstens 1e100 rad/m sein.",),
    "frequency_count": ("Ein Raster braucht mindestens zwei Frequenzen je Achse.",),
    "section_no_area": ("Die Flächen haben keinen Inhalt. Andere Flächen auswählen.",),
    "section_encloses_nothing": ("Die Umrisse umschließen keine Fläche. Sie schließen.",),
    "section_not_flat": (
        "Nicht eben: Punkte liegen bis zu {share:percent} der Größe außerhalb einer Ebene. Flächen einer Ebene "
        "auswählen oder sie eben machen.",
    ),
    "outlines_cross": (
        "Umrisse kreuzen oder überlappen sich. Sie auseinanderbewegen oder in ein Netz umwandeln und seine Flächen "
        "vereinigen.",
    ),
    "outlines_cross_at": (
        "Umrisse kreuzen sich an {count} Stelle. Sie auseinanderbewegen oder in ein Netz umwandeln und seine "
        "Flächen vereinigen.",
        "Umrisse kreuzen sich an {count} Stellen. Sie auseinanderbewegen oder in ein Netz umwandeln und seine "
        "Flächen vereinigen.",
    ),
    "outlines_coincide": ("Zwei Umrisse fallen zusammen. Einen löschen.",),
    "outline_open": (
        "Der Umriss ist an {count} Ecke offen. Ihn schließen.",
        "Der Umriss ist an {count} Ecken offen. Ihn schließen.",
    ),
    "section_face_crosses_itself": ("Einige Flächen kreuzen sich selbst. Sie dort zerschneiden.",),
    "section_faces_reversed": (
        "{count} Fläche zeigt andersherum und zählt mit den anderen.",
        "{count} Flächen zeigen andersherum und zählen mit den anderen.",
    ),
    "section_faces_overlap": (
        "Flächen überlappen oder kreuzen sich; die gemeinsame Fläche zählt für jede. Sie trennen.",
    ),
    "section_overlap_unchecked": ("Zu viele Kanten, um alle auf Überlappung zu prüfen.",),
    "section_projected": (
        "Punkte bis zu {share:percent} der Größe außerhalb der Ebene wurden projiziert. Die Flächen eben machen.",
    ),
    "section_projected_slightly": ("Punkte bis zu {share:percent} der Größe außerhalb der Ebene wurden projiziert.",),
    "section_fill_wrong": (
        "Blenders Füllung deckt {share:percent} der Fläche; gemessen wurden die Umrisse. Sie vereinfachen.",
    ),
    "section_modified_fill": ("Blenders Füllung mit ihren Modifikatoren wurde gemessen.",),
    "section_without_modifiers": ("Die Flächen im Bearbeitungsmodus wurden ohne Modifikatoren gemessen: {modifiers}.",),
    "section_splines_open": (
        "{count} offener Spline umschließt nichts und wurde weggelassen. Zyklisch umschalten verwenden.",
        "{count} offene Splines umschließen nichts und wurden weggelassen. Zyklisch umschalten verwenden.",
    ),
    "section_not_filled": ("Die Kurve ist nicht gefüllt; ihre Umrisse wurden wie gefüllt gemessen.",),
    "section_drawn_as_polygons": (
        "Kurven wurden als gezeichnete Polygone gemessen ({corners} Ecken, Auflösung {resolution}). Doppelte "
        "Auflösung macht den Fehler viermal kleiner.",
    ),
    "section_render_resolution": ("Die Auflösung des Ansichtsfensters wurde verwendet; gerendert ist sie {render}.",),
    "section_no_selected_face": ("Keine Fläche ausgewählt. Die Flächen des Querschnitts auswählen.",),
    "section_no_outline_text": ("Kein geschlossener Umriss. Einen Text eingeben.",),
    "section_no_outline_curve": ("Kein geschlossener Umriss. Die Splines mit Zyklisch umschalten schließen.",),
    "section_text_on_curve": (
        "Der Text folgt einer Kurve und ist nicht gefüllt. Ihn füllen oder Objekt > Konvertieren > Netz verwenden.",
    ),
    "section_3d_curve": (
        "Eine 3D-Kurve umschließt kein ebenes Gebiet. Sie in Objektdateneigenschaften > Form auf 2D setzen.",
    ),
    "section_extruded": (
        "Die Kurve ist extrudiert oder abgerundet. Extrudieren und Tiefe der Abrundung auf 0 setzen.",
    ),
    "section_offset": (
        "Der Versatz verschiebt den gefüllten Umriss. Ihn auf 0 setzen oder Objekt > Konvertieren > Netz verwenden.",
    ),
    "section_non_finite": (
        "Einige Punkte haben keine endlichen Koordinaten. Sie löschen oder berichtigen, was sie erzeugt hat.",
    ),
    "file_missing": ("Keine solche Datei.",),
    "file_not_regular": ("Keine gewöhnliche Datei.",),
    "file_unreadable": ("Die Datei lässt sich nicht lesen: {error}.",),
    "threemf_damaged": ("Die 3MF-Datei ist beschädigt: {error}. Sie neu exportieren.",),
    "threemf_field": (
        "Die 3MF-Datei hat „{text}“ in <{element}> auf Zeile {line}, was sich nicht lesen lässt. Sie neu exportieren.",
    ),
    "threemf_extension": (
        "Die 3MF-Datei braucht eine Erweiterung, die ihre Form ändert und nicht gelesen wird: {name}. Sie als "
        "einfache Netze exportieren.",
    ),
    "threemf_instances": ("Die 3MF-Datei setzt mehr als {limit} Netze. Einige verbinden.",),
    "file_exists": ("Die Datei „{file}“ gibt es schon. Überschreiben einschalten.",),
    "volume_not_written": ("Das Volumen lässt sich nicht schreiben: {error}",),
    "openvdb_missing": ("Dieses Python hat kein Modul openvdb. Blender verwenden.",),
    "no_import_file": ("Keine Datei gewählt. Einen Scan wählen.",),
    "out_of_memory": ("Zu wenig Speicher. Allein messen, verkleinern oder einen größeren Rechner verwenden.",),
    "file_newer_version": (
        "Die Datei wurde von einem neueren Blender ({version}) als diesem ({blender}) gespeichert, das vielleicht "
        "etwas davon verloren hat. Jenes Blender verwenden.",
    ),
    "internal_error": ("Interner Fehler: {type}: {error} ({where}). Bitte melden.",),
    "library_line_too_long": (
        "{file}: Zeile {line} hat mehr als {limit} Byte. Die Bibliothek mit --format jsonl schreiben.",
    ),
    "library_line": (
        "{file}: Zeile {line} ist kein Dokument von body_moments. Die Bibliothek mit --format jsonl schreiben.",
    ),
    "record_without_shape": (
        "{name}: keine Signatur, da der Körper keine Form hat; siehe die Befunde seines Datensatzes.",
    ),
    "record_without_signature": ("{name}: keine Signatur. Mit --signature messen.",),
    "signature_unrecognized": ("Die Signatur wurde nicht von --signature geschrieben.",),
    "signature_incomplete": ("Die Signatur ist unvollständig.",),
}
