# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German tooltips of operators, and other long texts."""

# Texts of the interface, as they stand in the source → German
TEXTS = {
    "Copy the stored mass properties of the selected objects to the clipboard as a table, in SI units": (
        "Die gespeicherten Masseneigenschaften der ausgewählten Objekte als Tabelle in die Zwischenablage kopieren, in "
        "SI-Einheiten"
    ),
    "Save the stored mass properties of the selected objects and their total, in SI units, as .csv, .json or .jsonl": (
        "Die gespeicherten Masseneigenschaften der ausgewählten Objekte und ihre Summe in SI-Einheiten als .csv, .json "
        "oder .jsonl speichern"
    ),
    "Overlapping components were united by Blender's exact Boolean, accurate to 7 digits": (
        "Überlappende Komponenten wurden mit Blenders exaktem Boolean vereinigt, auf 7 Stellen genau"
    ),
    "Accept this warning for the active object: it becomes a note, also when the object is measured again": (
        "Diese Warnung für das aktive Objekt annehmen: sie wird ein Hinweis, auch wenn das Objekt neu gemessen wird"
    ),
    "Add an empty at the center of mass, along the principal axes, with arrows as long as the largest radius of "
    "gyration. An empty added before is moved": (
        "Ein Empty im Massenmittelpunkt entlang der Hauptträgheitsachsen hinzufügen, mit Pfeilen so lang wie der "
        "größte Trägheitsradius. Ein früher hinzugefügtes wird bewegt"
    ),
    "Parent the empty to the object, so that it moves along": "Das Empty an das Objekt hängen, damit es sich mitbewegt",
    "Length of the axes as a multiple of the largest radius of gyration": (
        "Länge der Achsen als Vielfaches des größten Trägheitsradius"
    ),
    "Add the node group “Center of Mass” to the file, marked as an asset: it computes center, volume and mass in "
    "geometry nodes, follows modifiers and animation, and works without the add-on": (
        "Der Datei die Knotengruppe „Center of Mass“ hinzufügen, als Asset markiert: sie berechnet Mittelpunkt, "
        "Volumen und Masse in Geometrieknoten, folgt Modifikatoren und Animation und arbeitet ohne das Add-on"
    ),
    "Add an object that shows the center of mass of the active object at every frame": (
        "Ein Objekt hinzufügen, das in jedem Bild den Massenmittelpunkt des aktiven Objekts zeigt"
    ),
    "Rotate the object so that its principal axes align with the world axes, about its center of mass or at the "
    "world origin. Children follow": (
        "Das Objekt so drehen, dass seine Hauptträgheitsachsen entlang der Weltachsen liegen, um seinen "
        "Massenmittelpunkt oder am Weltursprung. Kinder folgen"
    ),
    "World axes for principal axes 1, 2 and 3 (smallest to largest moment)": (
        "Weltachsen für die Hauptträgheitsachsen 1, 2 und 3 (kleinstes bis größtes Moment)"
    ),
    "Smallest moment about X, largest moment about Z": "Kleinstes Moment um X, größtes um Z",
    "Smallest moment about Y, largest moment about X": "Kleinstes Moment um Y, größtes um X",
    "Smallest moment about Z, largest moment about Y": "Kleinstes Moment um Z, größtes um Y",
    "Smallest moment about X, largest moment about Y": "Kleinstes Moment um X, größtes um Y",
    "Smallest moment about Y, largest moment about Z": "Kleinstes Moment um Y, größtes um Z",
    "Smallest moment about Z, largest moment about X": "Kleinstes Moment um Z, größtes um X",
    "Take axes 1 and 2 in the direction of positive third moments, as in the paper. Objects for which the rule is "
    "undefined, such as most symmetric ones, are left unchanged": (
        "Achsen 1 und 2 in Richtung positiver dritter Momente nehmen, wie im Aufsatz. Objekte, bei denen die Regel "
        "nicht bestimmt ist, etwa die meisten symmetrischen, bleiben unverändert"
    ),
    "Add an empty at the center of mass of the assembly, along its principal axes. One added before is moved": (
        "Ein Empty im Massenmittelpunkt der Baugruppe entlang ihrer Hauptträgheitsachsen hinzufügen. Ein früher "
        "hinzugefügtes wird bewegt"
    ),
    "The active collection with its nested collections": "Die aktive Sammlung mit ihren verschachtelten Sammlungen",
    "Put the origin of the assembly at its center of mass: the offset of a collection's instances, or the empty, "
    "whose children stay where they are": (
        "Den Ursprung der Baugruppe in ihren Massenmittelpunkt legen: den Versatz der Instanzen einer Sammlung, "
        "oder das Empty, dessen Kinder bleiben, wo sie sind"
    ),
    "Move the origin to the center of mass and align the local X, Y and Z axes with the principal axes, from the "
    "smallest moment to the largest, with unit scale. Nothing visible moves": (
        "Den Ursprung in den Massenmittelpunkt bewegen und die lokalen Achsen X, Y und Z auf die "
        "Hauptträgheitsachsen ausrichten, vom kleinsten zum größten Moment, mit Skalierung eins. Nichts Sichtbares "
        "bewegt sich"
    ),
    "Take the axis from two selected vertices in Edit Mode, or from the origins of two selected objects": (
        "Die Achse durch zwei im Bearbeitungsmodus ausgewählte Punkte oder die Ursprünge zweier ausgewählter "
        "Objekte nehmen"
    ),
    "Remove the stored results from the selected objects. Settings are kept": (
        "Die gespeicherten Ergebnisse der ausgewählten Objekte entfernen. Einstellungen bleiben"
    ),
    "Remove the stored results of the assembly. Its settings and the results of its members are kept": (
        "Die gespeicherten Ergebnisse der Baugruppe entfernen. Ihre Einstellungen und die Ergebnisse ihrer "
        "Mitglieder bleiben"
    ),
    "Remove the stored results of the active armature and its bones. Settings are kept": (
        "Die gespeicherten Ergebnisse der aktiven Armatur und ihrer Knochen entfernen. Einstellungen bleiben"
    ),
    "Compute all moments of the active object's volume, surface and mass, or of the area of what is flat, up to the "
    "chosen order. A million triangles take about 1 second at order 4 and 20 seconds at order 20": (
        "Alle Momente von Volumen, Oberfläche und Masse des aktiven Objekts oder der Fläche von Ebenem bis zur "
        "gewählten Ordnung berechnen. Eine Million Dreiecke brauchen bei Ordnung 4 etwa 1 Sekunde, bei Ordnung 20 "
        "etwa 20"
    ),
    "Copy all computed moments and their error bounds to the clipboard as CSV": (
        "Alle berechneten Momente und ihre Fehlerschranken als CSV in die Zwischenablage kopieren"
    ),
    "Copy the inertia of the active object about the chosen reference, with its bounds, as text in SI units": (
        "Die Trägheit des aktiven Objekts um den gewählten Bezug mit ihren Schranken als Text in SI-Einheiten kopieren"
    ),
    "Copy the stored mass properties of the selected objects and their total to the clipboard, as text in SI units": (
        "Die gespeicherten Masseneigenschaften der ausgewählten Objekte und ihre Summe als Text in SI-Einheiten in "
        "die Zwischenablage kopieren"
    ),
    "Copy the stored section properties of the active object to the clipboard, as text in SI units": (
        "Die gespeicherten Querschnittswerte des aktiven Objekts als Text in SI-Einheiten in die Zwischenablage "
        "kopieren"
    ),
    "Copy kind, material, density or mass, wall and overlaps from the active object to the other selected objects": (
        "Art, Material, Dichte oder Masse, Wand und Überlappungen vom aktiven Objekt auf die anderen ausgewählten "
        "Objekte kopieren"
    ),
    "Copy this value to the clipboard in SI units, with all digits": (
        "Diesen Wert in SI-Einheiten mit allen Stellen in die Zwischenablage kopieren"
    ),
    "Unite the overlapping components of the active object before it is measured, and measure it again": (
        "Die überlappenden Komponenten des aktiven Objekts vor dem Messen vereinigen und es neu messen"
    ),
    "Create a transform orientation along the principal axes of the active object": (
        "Eine Transformationsorientierung entlang der Hauptträgheitsachsen des aktiven Objekts anlegen"
    ),
    "Name of the orientation. If empty, the object's name. An orientation of this name is replaced": (
        "Name der Orientierung. Leer: der Name des Objekts. Eine Orientierung dieses Namens wird ersetzt"
    ),
    "Write the masses, centers and inertia of all members of an assembly as a table (.csv), in SI units": (
        "Massen, Mittelpunkte und Trägheit aller Mitglieder einer Baugruppe als Tabelle (.csv) in SI-Einheiten "
        "schreiben"
    ),
    "Compare the shape of the active object with those of a library, written by the command line with --signature "
    "--format jsonl": (
        "Die Form des aktiven Objekts mit denen einer Bibliothek vergleichen, die von der Kommandozeile mit "
        "--signature --format jsonl geschrieben wurde"
    ),
    "Compare the shapes of all visible objects with the active object, in any pose, size and triangulation, and "
    "list copies, mirror images and similar shapes": (
        "Die Formen aller sichtbaren Objekte mit dem aktiven vergleichen, in jeder Lage, Größe und "
        "Dreieckszerlegung, und Kopien, Spiegelbilder und ähnliche Formen auflisten"
    ),
    "Select the copies of the active object, and deselect everything else": (
        "Die Kopien des aktiven Objekts auswählen und alles andere abwählen"
    ),
    "Find the rotation axes and mirror planes through the center of mass of the selected objects that moments allow "
    "and the surface, or of flat shapes the outline, confirms": (
        "Die Drehachsen und Spiegelebenen durch den Massenmittelpunkt der ausgewählten Objekte finden, die Momente "
        "erlauben und die Oberfläche, bei ebenen Formen der Umriss, bestätigt"
    ),
    "Largest allowed distance of the surface from its images, relative to the radius of gyration": (
        "Größter erlaubter Abstand der Oberfläche von ihren Bildern, im Verhältnis zum Trägheitsradius"
    ),
    "Write the Fourier transform of the active object on a regular grid of frequencies to an .npz file, and show "
    "slices of its magnitude as an image": (
        "Die Fourier-Transformation des aktiven Objekts auf einem regelmäßigen Raster von Frequenzen in eine "
        ".npz-Datei schreiben und Schnitte ihres Betrags als Bild zeigen"
    ),
    "∫ exp(−i q·x) dV in m³. For shells, area times thickness": "∫ exp(−i q·x) dV in m³. Bei Schalen Fläche mal Dicke",
    "Location and rotation of the object, with unit scale": "Position und Rotation des Objekts, mit Skalierung eins",
    "Number of frequencies along each axis. 0 is in the middle, as after numpy.fft.fftshift": (
        "Zahl der Frequenzen je Achse. 0 liegt in der Mitte, wie nach numpy.fft.fftshift"
    ),
    "Highest frequency along each axis in rad/m. 0 uses that of a discrete Fourier transform of a box of twice the "
    "object's size": (
        "Höchste Frequenz je Achse in rad/m. 0: die einer diskreten Fourier-Transformation eines Quaders von der "
        "doppelten Größe des Objekts"
    ),
    "Write the Fourier transform of the active object to a file": (
        "Die Fourier-Transformation des aktiven Objekts in eine Datei schreiben"
    ),
    "A .npy file with the position of each sample along x, ascending. Empty if they are even": (
        "Eine .npy-Datei mit der Stelle jedes Abtastwerts entlang x, aufsteigend. Leer, wenn sie gleichmäßig sind"
    ),
    "A .npy file with the position of each sample along y, ascending. Empty if they are even": (
        "Eine .npy-Datei mit der Stelle jedes Abtastwerts entlang y, aufsteigend. Leer, wenn sie gleichmäßig sind"
    ),
    "A .npy file with the position of each sample along z, ascending. Empty if they are even": (
        "Eine .npy-Datei mit der Stelle jedes Abtastwerts entlang z, aufsteigend. Leer, wenn sie gleichmäßig sind"
    ),
    "Meters per unit of the files of positions": "Meter je Einheit der Dateien mit Stellen",
    "Where the samples of an imported scan stand along x, y and z, in voxels, if not evenly": (
        "Wo die Abtastwerte eines importierten Scans entlang x, y und z stehen, in Voxeln, wenn nicht gleichmäßig"
    ),
    "Import the B-spline surfaces of IGES files, and of .obj files with surf, as they are": (
        "Die B-Spline-Flächen von IGES-Dateien, und von .obj-Dateien mit surf, importieren, wie sie sind"
    ),
    "Meters per unit of .obj files, which state no unit. IGES files state theirs": (
        "Meter je Einheit von .obj-Dateien, die keine Einheit angeben. IGES-Dateien geben ihre an"
    ),
    "Import a scan or array of densities as a Volume object. A .vdb file is written beside it": (
        "Einen Scan oder ein Feld von Dichten als Volumenobjekt importieren. Eine .vdb-Datei wird daneben geschrieben"
    ),
    "Distance between samples along x, y and z in meters": "Abstand der Abtastwerte entlang x, y und z in Metern",
    "Replace an existing .vdb file beside the scan": "Eine vorhandene .vdb-Datei neben dem Scan ersetzen",
    "Read a file of samples that the header names outside of its own folder. Only for trusted headers": (
        "Eine Datei von Abtastwerten lesen, die der Kopf außerhalb seines Ordners nennt. Nur bei Köpfen, denen man "
        "traut"
    ),
    "Number of samples of a .raw file along x, y and z, x fastest. 0 if the file name states it": (
        "Zahl der Abtastwerte einer .raw-Datei entlang x, y und z, x am schnellsten. 0, wenn der Dateiname sie nennt"
    ),
    "The most significant byte comes first in a .raw file": "In einer .raw-Datei kommt das höchstwertige Byte zuerst",
    "Move and rotate the other selected objects onto the active object by centers of mass and principal axes, and "
    "report the distance between the surfaces. Symmetric objects take the nearest of their poses; mirror images are "
    "left unchanged": (
        "Die anderen ausgewählten Objekte nach Massenmittelpunkten und Hauptträgheitsachsen auf das aktive bewegen "
        "und drehen und den Abstand der Oberflächen melden. Symmetrische Objekte nehmen die nächste ihrer Lagen; "
        "Spiegelbilder bleiben unverändert"
    ),
    "Compute the exact mass properties of the selected objects and store them as custom properties": (
        "Die exakten Masseneigenschaften der ausgewählten Objekte berechnen und als eigene Eigenschaften speichern"
    ),
    "Material to give the objects before they are measured": "Material, das die Objekte vor dem Messen bekommen",
    "The surface bounds a volume filled with material": "Die Oberfläche begrenzt ein mit Material gefülltes Volumen",
    "The surface is a sheet or wall of the given thickness": (
        "Die Oberfläche ist ein Blech oder eine Wand der gegebenen Dicke"
    ),
    "How overlapping or nested components of an object count": (
        "Wie überlappende oder verschachtelte Komponenten eines Objekts zählen"
    ),
    "Measure the active object as a sheet of the given thickness": (
        "Das aktive Objekt als Blech der gegebenen Dicke messen"
    ),
    "Thickness of the sheet. At 0, that of the object's settings": (
        "Dicke des Blechs. Bei 0 die der Einstellungen des Objekts"
    ),
    "Measure all members of a collection, or all children of an empty, and store the total on it": (
        "Alle Mitglieder einer Sammlung oder alle Kinder eines Empty messen und die Summe dort speichern"
    ),
    "Measure the part of each bone of the active armature in rest pose, and store it on the pose bone": (
        "Den Teil jedes Knochens der aktiven Armatur in Ruhepose messen und am Posenknochen speichern"
    ),
    "Compute the section properties of the selected faces in Edit Mode, or of the selected flat meshes, 2D curves "
    "and texts, and store them on the objects": (
        "Die Querschnittswerte der im Bearbeitungsmodus ausgewählten Flächen oder der ausgewählten ebenen Netze, "
        "2D-Kurven und Texte berechnen und an den Objekten speichern"
    ),
    "Move the origin to the exact center of mass of the evaluated object. Nothing visible moves: children and other "
    "users of the data stay in place. Objects whose modifiers depend on the origin are left unchanged": (
        "Den Ursprung in den exakten Massenmittelpunkt des ausgewerteten Objekts bewegen. Nichts Sichtbares bewegt "
        "sich: Kinder und andere Benutzer der Daten bleiben am Ort. Objekte, deren Modifikatoren vom Ursprung "
        "abhängen, bleiben unverändert"
    ),
    "Create a rigid body for the part of each bone, in rest pose, with its exact mass, its origin at its center of "
    "mass and its axes along its principal axes, and a joint at each bone. One created before is replaced": (
        "Für den Teil jedes Knochens in Ruhepose einen Starrkörper mit seiner exakten Masse anlegen, den Ursprung "
        "im Massenmittelpunkt und die Achsen entlang der Hauptträgheitsachsen, und ein Gelenk an jedem Knochen. Ein "
        "früher angelegter wird ersetzt"
    ),
    "Add or remove a preset of the active object's settings": (
        "Eine Voreinstellung aus den Einstellungen des aktiven Objekts hinzufügen oder entfernen"
    ),
    "Reverse the faces of the active mesh that were measured as reversed: flipped ones, and those of components "
    "that are inside out. Cavities keep facing inward. Other objects that use the mesh change too": (
        "Die Flächen des aktiven Netzes umdrehen, die umgedreht gemessen wurden: verdrehte und die umgestülpter "
        "Komponenten. Hohlräume zeigen weiter nach innen. Andere Objekte, die das Netz verwenden, ändern sich auch"
    ),
    "Lay the selected objects on the ground in a stable pose, the likeliest or another one. They turn by the "
    "smallest angle about the center of mass, which stays above the same point": (
        "Die ausgewählten Objekte in einer stabilen Lage auf den Boden legen, der wahrscheinlichsten oder einer "
        "anderen. Sie drehen sich um den kleinsten Winkel um den Massenmittelpunkt, der über demselben Punkt bleibt"
    ),
    "Stable pose, the likeliest first. 0 for the one that is reached by the smallest turn": (
        "Stabile Lage, die wahrscheinlichste zuerst. 0 für die mit der kleinsten Drehung"
    ),
    "Add an empty that stays at the center of mass of the character in every pose, by constraints to the centers of "
    "the bones' parts. One added before is replaced": (
        "Ein Empty hinzufügen, das in jeder Pose im Massenmittelpunkt der Figur bleibt, durch Beschränkungen auf "
        "die Mittelpunkte der Knochenteile. Ein früher hinzugefügtes wird ersetzt"
    ),
    "Make it stand: move the selected vertices (in Object Mode those of a vertex group) as little as possible to "
    "bring the center of mass over a point": (
        "Zum Stehen bringen: die ausgewählten Punkte (im Objektmodus die einer Punktgruppe) so wenig wie möglich "
        "bewegen, um den Massenmittelpunkt über einen Punkt zu bringen"
    ),
    "In which directions the center of mass is brought to the target": (
        "In welchen Richtungen der Massenmittelpunkt zum Ziel gebracht wird"
    ),
    "Onto the line through the target along gravity, at any height": (
        "Auf die Gerade durch das Ziel entlang der Schwerkraft, in beliebiger Höhe"
    ),
    "Longest move of a vertex. 0 for the size of the mesh": (
        "Weiteste Bewegung eines Punkts. 0 für die Größe des Netzes"
    ),
    "Vertices that may move in Object Mode, in proportion to their weights. If empty, the active group": (
        "Punkte, die sich im Objektmodus bewegen dürfen, im Verhältnis ihrer Gewichte. Leer: die aktive Gruppe"
    ),
    "Measure the selected meshes and select their defects in Edit Mode: boundary and non-manifold edges, and "
    "flipped, duplicate and zero-area faces. Objects without defects are deselected": (
        "Die ausgewählten Netze messen und ihre Fehlerstellen im Bearbeitungsmodus auswählen: Randkanten, Kanten "
        "mit mehr als zwei Flächen und verdrehte, doppelte und inhaltslose Flächen. Objekte ohne Fehlerstellen "
        "werden abgewählt"
    ),
    "Edges whose two faces point to opposite sides": "Kanten, deren zwei Flächen nach verschiedenen Seiten zeigen",
    "Select the objects that the last action refused or warned of": (
        "Die Objekte auswählen, die die letzte Aktion abgelehnt oder vor denen sie gewarnt hat"
    ),
    "Set the density of the selected objects to that of a material. With Density From set to Materials, it applies "
    "to faces whose material has no density": (
        "Die Dichte der ausgewählten Objekte auf die eines Materials setzen. Mit Dichte aus: Materialien gilt sie "
        "für Flächen, deren Material keine Dichte hat"
    ),
    "Set the mass of rigid bodies to the measured mass in kilograms. The physics engine uses the origin as center "
    "of mass; use Axes to Principal Axes as well": (
        "Die Masse von Starrkörpern auf die gemessene Masse in Kilogramm setzen. Die Physik nimmt den Ursprung als "
        "Massenmittelpunkt; auch Achsen auf Hauptachsen verwenden"
    ),
    "Add an active rigid body to objects without one": "Objekten ohne Starrkörper einen aktiven hinzufügen",
    "Move origins to the centers of mass and align the local axes with the principal axes, as the physics engine takes "
    "them to be. Nothing visible moves": "Ursprünge in die Massenmittelpunkte setzen und die lokalen Achsen an den "
    "Hauptachsen ausrichten, wie die Physik-Engine sie annimmt. Sichtbar bewegt sich nichts",
    "Compute whether the selected objects stand on the ground below them, how far the ground can be tilted, and in "
    "which poses they rest. Objects are measured where their results are out of date": (
        "Berechnen, ob die ausgewählten Objekte auf dem Boden unter ihnen stehen, wie weit er geneigt werden kann "
        "und in welchen Lagen sie ruhen. Objekte mit veralteten Ergebnissen werden gemessen"
    ),
    "Store the inertia of the selected objects about the chosen reference as custom properties": (
        "Die Trägheit der ausgewählten Objekte um den gewählten Bezug als eigene Eigenschaften speichern"
    ),
    "Keep the units of the scene, and do not ask again": "Die Einheiten der Szene behalten und nicht wieder fragen",
    "Let one unit of the scene be a millimeter, and measure again what was measured": (
        "Eine Einheit der Szene einen Millimeter sein lassen und neu messen, was gemessen war"
    ),
    "Measure the objects of the view layer that were measured, as all their numbers change": (
        "Die gemessenen Objekte der Ansichtsebene neu messen, da sich alle ihre Zahlen ändern"
    ),
    "Move the 3D cursor to the center of mass of the assembly": (
        "Den 3D-Cursor auf den Massenmittelpunkt der Baugruppe bewegen"
    ),
    "Move the 3D cursor to the common center of mass of the selected objects": (
        "Den 3D-Cursor auf den gemeinsamen Massenmittelpunkt der ausgewählten Objekte bewegen"
    ),
    "Hide what the last action refused or warned of": (
        "Ausblenden, was die letzte Aktion abgelehnt oder wovor sie gewarnt hat"
    ),
    "Set the density of a Blender material from the material table": (
        "Die Dichte eines Blender-Materials aus der Materialtabelle setzen"
    ),
    "Entry of the material table to take the density from": (
        "Eintrag der Materialtabelle, von dem die Dichte genommen wird"
    ),
    "Export glTF as Blender does, with rigid bodies of the exact mass, center and inertia in it": (
        "glTF wie Blender exportieren, mit Starrkörpern von exakter Masse, exaktem Mittelpunkt und exakter Trägheit "
        "darin"
    ),
    "Export selected objects only, else all that are rendered": (
        "Nur ausgewählte Objekte exportieren, sonst alle, die gerendert werden"
    ),
    "Each object is a link; its parent holds it by a fixed joint": (
        "Jedes Objekt ist ein Glied; sein Elternobjekt hält es mit einem festen Gelenk"
    ),
    "The ellipsoid of the same mass, center and inertia": (
        "Das Ellipsoid von gleicher Masse, gleichem Mittelpunkt und gleicher Trägheit"
    ),
    "The capsule of the same mass and center, with the inertia that comes nearest": (
        "Die Kapsel von gleicher Masse und gleichem Mittelpunkt mit der nächsten Trägheit"
    ),
    "Write mass, center and inertia of each link and nothing else": (
        "Masse, Mittelpunkt und Trägheit jedes Glieds schreiben und sonst nichts"
    ),
    "Export objects as bodies of a model for MuJoCo, with their exact mass, center and inertia": (
        "Objekte als Körper eines Modells für MuJoCo exportieren, mit exakter Masse, exaktem Mittelpunkt und "
        "exakter Trägheit"
    ),
    "Export objects as links of a model in SDFormat, with their exact mass, center and inertia": (
        "Objekte als Glieder eines Modells in SDFormat exportieren, mit exakter Masse, exaktem Mittelpunkt und "
        "exakter Trägheit"
    ),
    "Export objects as links of a robot in URDF, with their exact mass, center and inertia": (
        "Objekte als Glieder eines Roboters in URDF exportieren, mit exakter Masse, exaktem Mittelpunkt und exakter "
        "Trägheit"
    ),
    "Export the geometry as Blender does, and a layer of text that gives it the exact mass, center and inertia": (
        "Die Geometrie wie Blender exportieren und eine Textebene, die ihr exakte Masse, exakten Mittelpunkt und "
        "exakte Trägheit gibt"
    ),
    "Draw the center of mass and the principal axes of measured objects in the 3D Viewport": (
        "Massenmittelpunkt und Hauptträgheitsachsen gemessener Objekte im 3D-Ansichtsfenster zeichnen"
    ),
    "Draw all visible measured objects instead of the selected ones": (
        "Alle sichtbaren gemessenen Objekte statt der ausgewählten zeichnen"
    ),
    "Draw the principal axes 1, 2 and 3, each as long as its radius of gyration in both directions": (
        "Die Hauptträgheitsachsen 1, 2 und 3 zeichnen, jede in beide Richtungen so lang wie ihr Trägheitsradius"
    ),
    "Draw a line from the center of mass straight down or up to the floor, Z = 0": (
        "Eine Linie vom Massenmittelpunkt senkrecht zum Boden Z = 0 zeichnen"
    ),
    "Measure all files of a folder or an asset library in separate processes, and write results and a report there": (
        "Alle Dateien eines Ordners oder einer Asset-Bibliothek in eigenen Prozessen messen und Ergebnisse und einen "
        "Bericht dort ablegen"
    ),
    "Folder with the files to measure": "Ordner mit den zu messenden Dateien",
    "Folder or asset library to measure": "Zu messender Ordner oder zu messende Asset-Bibliothek",
    "Write mass, volume and center into the metadata of the objects and collections that are assets": (
        "Masse, Volumen und Mittelpunkt in die Metadaten der Objekte und Sammlungen schreiben, die Assets sind"
    ),
    "Save the metadata in the asset files themselves instead of in copies beside them": (
        "Die Metadaten in den Asset-Dateien selbst speichern statt in Kopien daneben"
    ),
    "Draw a picture of each body in the report": "Jeden Körper im Bericht abbilden",
}
