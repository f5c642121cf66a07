# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German tooltips of settings and panels, and other long texts."""

# Texts of the interface, as they stand in the source → German
TEXTS = {
    "Draw the body of uniform density that has the same mass and the same principal moments": (
        "Den Körper gleichmäßiger Dichte mit gleicher Masse und gleichen Hauptträgheitsmomenten zeichnen"
    ),
    "Draw the center of mass and the principal axes of the selected objects as one body": (
        "Massenmittelpunkt und Hauptträgheitsachsen der ausgewählten Objekte als eines Körpers zeichnen"
    ),
    "Draw boundary edges and flipped faces that were found when the object was measured": (
        "Randkanten und verdrehte Flächen zeichnen, die beim Messen gefunden wurden"
    ),
    "Draw the support polygon and the direction of tipping of objects whose stability was computed": (
        "Das Standpolygon und die Kipprichtung von Objekten zeichnen, deren Standfestigkeit berechnet wurde"
    ),
    "Draw the path of the center of mass that was computed over the frame range": (
        "Den Pfad des Massenmittelpunkts zeichnen, der über den Bildbereich berechnet wurde"
    ),
    "Enter the center of mass instead of taking that of the geometry": (
        "Den Massenmittelpunkt eingeben, statt den der Geometrie zu nehmen"
    ),
    "Center of mass from the origin, along the axes of the object. Of a collection, in the world": (
        "Massenmittelpunkt vom Ursprung aus, entlang der Objektachsen. Bei einer Sammlung in der Welt"
    ),
    "Enter the inertia tensor instead of taking that of the geometry with the given mass": (
        "Den Trägheitstensor eingeben, statt den der Geometrie mit der gegebenen Masse zu nehmen"
    ),
    "Diagonal of the inertia tensor about the center of mass in kg·m², independent of the scene units, along the "
    "axes of the object. Of a collection, along the world axes": (
        "Diagonale des Trägheitstensors um den Massenmittelpunkt in kg·m², unabhängig von den Einheiten der Szene, "
        "entlang der Objektachsen. Bei einer Sammlung entlang der Weltachsen"
    ),
    "Tensor entries off the diagonal in kg·m², independent of the scene units: Ixy = −∫xy dm": (
        "Tensoreinträge neben der Diagonale in kg·m², unabhängig von den Einheiten der Szene: Ixy = −∫xy dm"
    ),
    "The curve is a wire of the given mass per length": "Die Kurve ist ein Draht der gegebenen Masse je Länge",
    "Whether density or mass is entered; the other is computed": (
        "Ob Dichte oder Masse eingegeben wird; die andere wird berechnet"
    ),
    "Enter the measured mass and compute the mean density": (
        "Die gewogene Masse eingeben und die mittlere Dichte berechnen"
    ),
    "Density of each material, per face of a shell and per closed component of a solid. Faces whose material has no "
    "density use the object's": (
        "Dichte jedes Materials, je Fläche einer Schale und je geschlossener Komponente eines Körpers. Flächen, "
        "deren Material keine Dichte hat, nehmen die des Objekts"
    ),
    "Polynomial in x, y and z, in kg/m³ for coordinates in meters": (
        "Polynom in x, y und z, in kg/m³ für Koordinaten in Metern"
    ),
    "Float attribute on the vertices of a shell, in kg/m³, interpolated linearly": (
        "Gleitkomma-Attribut an den Punkten einer Schale, in kg/m³, linear interpoliert"
    ),
    "Grid of a Volume object around a solid, constant in each voxel": (
        "Raster eines Volumenobjekts um einen massiven Körper, in jedem Voxel konstant"
    ),
    "Density in kg/m³ for x, y and z in meters, such as 1000 + 20*z. Alternatively the coefficients of 1, x, y, z, "
    "x², xy, xz, y², yz, z², … separated by commas": (
        "Dichte in kg/m³ für x, y und z in Metern, etwa 1000 + 20*z. Oder die Koeffizienten von 1, x, y, z, x², xy, "
        "xz, y², yz, z², … mit Kommas dazwischen"
    ),
    "Coordinate system of x, y and z in the polynomial": "Koordinatensystem von x, y und z im Polynom",
    "Meters along the object's axes from its origin, mirrored by a negative scale. Each instance has its own": (
        "Meter entlang der Objektachsen vom Ursprung, gespiegelt bei negativer Skalierung. Jede Instanz hat ihre "
        "eigenen"
    ),
    "Meters along the world axes from the world origin": "Meter entlang der Weltachsen vom Weltursprung",
    "Float attribute on the vertices with the density in kg/m³, after modifiers": (
        "Gleitkomma-Attribut an den Punkten mit der Dichte in kg/m³, nach Modifikatoren"
    ),
    "Density in kg/m³, independent of the scene units": "Dichte in kg/m³, unabhängig von den Einheiten der Szene",
    "Mass per length of the wire in kg/m, independent of the scene units": (
        "Masse je Länge des Drahts in kg/m, unabhängig von den Einheiten der Szene"
    ),
    "Mass in kilograms, independent of the scene units. Type pounds as 5*0.45359237": (
        "Masse in Kilogramm, unabhängig von den Einheiten der Szene. Pfund als 5*0.45359237 eingeben"
    ),
    "Position of the material relative to the surface": "Lage des Materials zur Oberfläche",
    "Real thickness behind the faces, with mitered corners": "Echte Dicke hinter den Flächen, mit Ecken auf Gehrung",
    "Real thickness in front of the faces, with mitered corners": "Echte Dicke vor den Flächen, mit Ecken auf Gehrung",
    "Real thickness, half behind and half in front of the faces, with mitered corners": (
        "Echte Dicke, halb hinter und halb vor den Flächen, mit Ecken auf Gehrung"
    ),
    "How overlapping or nested components of the object count": (
        "Wie überlappende oder verschachtelte Komponenten des Objekts zählen"
    ),
    "Every component counts fully; shared space counts twice, with a warning": (
        "Jede Komponente zählt voll; gemeinsamer Raum zählt doppelt, mit einer Warnung"
    ),
    "Components are united first by Blender's exact Boolean": (
        "Komponenten werden zuerst mit Blenders exaktem Boolean vereinigt"
    ),
    "Grid to measure. If empty, “density” or else the first suitable grid": (
        "Zu messendes Raster. Leer: „density“, sonst das erste geeignete Raster"
    ),
    "The values determine the density of each voxel": "Die Werte bestimmen die Dichte jedes Voxels",
    "The grid is a level set that bounds a solid filled with material": (
        "Das Raster ist eine Niveaumenge, die einen mit Material gefüllten Körper begrenzt"
    ),
    "The body where the values, linear between voxels, are at least a threshold": (
        "Der Körper, in dem die Werte, linear zwischen den Voxeln, mindestens ein Schwellwert sind"
    ),
    "Grid value from which on a point belongs to the body": "Rasterwert, ab dem ein Punkt zum Körper gehört",
    "What the body within the threshold is made of": "Woraus der Körper innerhalb des Schwellwerts besteht",
    "The density that the values of the grid represent": "Die Dichte, die die Werte des Rasters darstellen",
    "Use a transfer table, for example for CT numbers": "Eine Übertragungstabelle verwenden, etwa für CT-Zahlen",
    "Pairs of a grid value and a density in kg/m³, separated by commas. Linear in between, constant beyond. The "
    "default converts CT numbers to tissue densities": (
        "Paare aus einem Rasterwert und einer Dichte in kg/m³, mit Kommas dazwischen. Dazwischen linear, jenseits "
        "konstant. Die Vorgabe wandelt CT-Zahlen in Gewebedichten um"
    ),
    "Order of the spline whose coefficients the values are: 1 for voxels, 2 for trilinear, 4 for cubic": (
        "Ordnung des Splines, dessen Koeffizienten die Werte sind: 1 für Voxel, 2 für trilinear, 4 für kubisch"
    ),
    "Volume object whose grid is the density inside the solid": "Volumenobjekt, dessen Raster die Dichte im Körper ist",
    "Density in kg/m³, independent of the scene units. At 0, the density of the object is used": (
        "Dichte in kg/m³, unabhängig von den Einheiten der Szene. Bei 0 gilt die Dichte des Objekts"
    ),
    "Entry of the material table that the density was taken from": (
        "Eintrag der Materialtabelle, von dem die Dichte genommen wurde"
    ),
    "Axes and origin in which the center of mass, the axes and the tensor are shown": (
        "Achsen und Ursprung, in denen Massenmittelpunkt, Achsen und Tensor gezeigt werden"
    ),
    "Unit in which densities are shown and entered": "Einheit, in der Dichten gezeigt und eingegeben werden",
    "Significant digits of the largest number of a column. Copied values always have all digits": (
        "Gültige Stellen der größten Zahl einer Spalte. Kopierte Werte haben immer alle Stellen"
    ),
    "What separates groups of three digits in numbers of five digits and more": (
        "Was Gruppen von drei Ziffern in Zahlen ab fünf Stellen trennt"
    ),
    "Material of objects whose density has not been set": "Material von Objekten, deren Dichte nicht gesetzt wurde",
    "Density in kg/m³ of objects whose density has not been set": (
        "Dichte in kg/m³ von Objekten, deren Dichte nicht gesetzt wurde"
    ),
    "Highest p + q + r of the computed moments ∫ x^p y^q z^r": (
        "Höchstes p + q + r der berechneten Momente ∫ x^p y^q z^r"
    ),
    "What the moments integrate over": "Worüber die Momente integrieren",
    "Volume, or for shells the area, times the density wherever it comes from": (
        "Volumen, bei Schalen die Fläche, mal der Dichte, woher sie auch kommt"
    ),
    "Center of the volume or surface: central moments": (
        "Mittelpunkt des Volumens oder der Oberfläche: zentrale Momente"
    ),
    "∫ exp(−i q·x) dA of a flat shape in its own plane, in m²": (
        "∫ exp(−i q·x) dA einer ebenen Form in ihrer eigenen Ebene, in m²"
    ),
    "Area of a flat shape in its own plane, ∫ x^p y^q dA": (
        "Fläche einer ebenen Form in ihrer eigenen Ebene, ∫ x^p y^q dA"
    ),
    "Numbers of a flat shape that do not depend on its place, rotation and size: Hu's, then Flusser's": (
        "Zahlen einer ebenen Form, die nicht von Ort, Drehung und Größe abhängen: die von Hu, dann die von Flusser"
    ),
    "Central moments of the shape scaled to a volume or area of 1, independent of size": (
        "Zentrale Momente der auf Volumen oder Fläche 1 skalierten Form, unabhängig von der Größe"
    ),
    "Point and axes that Inertia about Reference refers to": "Punkt und Achsen, auf die sich Trägheit um Bezug bezieht",
    "An instance of a collection whose members have densities of their own": (
        "Eine Instanz einer Sammlung, deren Mitglieder eigene Dichten haben"
    ),
    "Why it is not counted, and what was noticed, as JSON": "Warum es nicht zählt und was aufgefallen ist, als JSON",
    "Whether the mass is the sum of the members or given, as of a bought part": (
        "Ob die Masse die Summe der Mitglieder oder gegeben ist, wie bei einem Kaufteil"
    ),
    "Enter the mass of the whole; the members give its center and inertia unless entered": (
        "Die Masse des Ganzen eingeben; die Mitglieder geben Mittelpunkt und Trägheit, wenn nicht eingegeben"
    ),
    "Mass of the whole in kilograms, independent of the scene units": (
        "Masse des Ganzen in Kilogramm, unabhängig von den Einheiten der Szene"
    ),
    "Point and axes that inertia and moments are referred to": (
        "Punkt und Achsen, auf die sich Trägheit und Momente beziehen"
    ),
    "Object whose origin and axes are the reference": "Objekt, dessen Ursprung und Achsen der Bezug sind",
    "A density for what is skinned to the bone; objects parented to it keep theirs": (
        "Eine Dichte für das, was an den Knochen gebunden ist; an ihn gehängte Objekte behalten ihre"
    ),
    "Density in kg/m³ of what is skinned to the bone, independent of the scene units": (
        "Dichte in kg/m³ dessen, was an den Knochen gebunden ist, unabhängig von den Einheiten der Szene"
    ),
    "Mass of the bone's part in kilograms, independent of the scene units": (
        "Masse des Knochenteils in Kilogramm, unabhängig von den Einheiten der Szene"
    ),
    "Size relative to the object that was searched for": "Größe im Verhältnis zum gesuchten Objekt",
    "Schoenflies symbol of the symmetry that the surface confirms": (
        "Schoenflies-Symbol der Symmetrie, die die Oberfläche bestätigt"
    ),
    "Schoenflies symbol of the symmetry that the moments allow": (
        "Schoenflies-Symbol der Symmetrie, die die Momente erlauben"
    ),
    "Largest distance of the surface from its images, relative to the radius of gyration": (
        "Größter Abstand der Oberfläche von ihren Bildern, im Verhältnis zum Trägheitsradius"
    ),
    "The display mesh of a NURBS surface was compared": "Das Anzeigenetz einer NURBS-Fläche wurde verglichen",
    "Milliseconds per redraw that live numbers may take before they lag behind": (
        "Millisekunden je Neuzeichnen, die mitlaufende Zahlen brauchen dürfen, bevor sie nachhinken"
    ),
    "A material's density, for objects that take theirs from their materials": (
        "Dichte eines Materials, für Objekte, die ihre von ihren Materialien nehmen"
    ),
    "Principal moments and axes, radii of gyration and inertia tensor": (
        "Hauptträgheitsmomente und -achsen, Trägheitsradien und Trägheitstensor"
    ),
    "A mass that is known, with or without its center and inertia": (
        "Eine bekannte Masse, mit oder ohne Mittelpunkt und Trägheit"
    ),
    "Use the center of mass and the principal axes in the scene": (
        "Massenmittelpunkt und Hauptträgheitsachsen in der Szene verwenden"
    ),
    "Whether the object stands on the ground below it, and the poses in which it rests": (
        "Ob das Objekt auf dem Boden unter ihm steht, und die Lagen, in denen es ruht"
    ),
    "A collection, or an empty with its children, as one body": (
        "Eine Sammlung oder ein Empty mit seinen Kindern als ein Körper"
    ),
    "The part of the active bone, in rest pose and the bone's rest frame": (
        "Der Teil des aktiven Knochens, in Ruhepose und dem Ruhesystem des Knochens"
    ),
    "Formats of robots and engines, with exact mass properties": (
        "Formate von Robotern und Engines, mit exakten Masseneigenschaften"
    ),
    "Densities of materials by category. Type to search": "Dichten von Materialien nach Gruppen. Tippen, um zu suchen",
    "3D Printing Resin and Powder, with their densities": "3D-Druck-Harz und -Pulver, mit Dichten",
    "About the centroid, Ix = ∫y² dA, Ixy = +∫xy dA": "Um den Schwerpunkt, Ix = ∫y² dA, Ixy = +∫xy dA",
    "Directions and normals along the object's axes": "Richtungen und Normalen entlang der Objektachsen",
    "Defaults, copied into a scene when it is first used": (
        "Vorgaben, die in eine Szene kopiert werden, wenn sie zuerst verwendet wird"
    ),
    "Density in kg/m³. At 0, the density of the object is used": "Dichte in kg/m³. Bei 0 gilt die Dichte des Objekts",
    "Density in g/cm³. At 0, the density of the object is used": "Dichte in g/cm³. Bei 0 gilt die Dichte des Objekts",
    "Density in lb/in³. At 0, the density of the object is used": "Dichte in lb/in³. Bei 0 gilt die Dichte des Objekts",
    "Density in lb/ft³. At 0, the density of the object is used": "Dichte in lb/ft³. Bei 0 gilt die Dichte des Objekts",
    "Height of the ground, against gravity from the world origin": (
        "Höhe des Bodens, gegen die Schwerkraft vom Weltursprung aus"
    ),
    "Collection whose objects are followed. If empty, the selected objects": (
        "Sammlung, deren Objekten gefolgt wird. Leer: die ausgewählten Objekte"
    ),
    "What is that near to the ground touches it. 0 for 1% of the size of the contact objects": (
        "Was dem Boden so nah ist, berührt ihn. 0 für 1 % der Größe der Kontaktobjekte"
    ),
    "Collection whose objects can touch the ground, such as feet. What of them is near the ground spans the support "
    "polygon. If empty, there is none": (
        "Sammlung, deren Objekte den Boden berühren können, etwa Füße. Was davon dem Boden nah ist, spannt das "
        "Standpolygon auf. Leer: keines"
    ),
    "Follow the common center of mass of the selected objects, of a collection, or of the meshes that the selected "
    "armatures deform, over the frame range. Adds an empty with keys, and draws the path": (
        "Dem gemeinsamen Massenmittelpunkt der ausgewählten Objekte, einer Sammlung oder der Netze, die die "
        "ausgewählten Armaturen verformen, über den Bildbereich folgen. Fügt ein Empty mit Schlüsselbildern hinzu "
        "und zeichnet den Pfad"
    ),
    "Each collection with all that it holds is a link, along the world's axes": (
        "Jede Sammlung mit allem, was sie hält, ist ein Glied, entlang der Weltachsen"
    ),
    "Add a simple shape with the mass, center of mass and inertia of each selected object": (
        "Für jedes ausgewählte Objekt eine einfache Form mit gleicher Masse, gleichem Massenmittelpunkt und "
        "gleicher Trägheit hinzufügen"
    ),
    "Make the shape an active rigid body with the mass, and the object its child": (
        "Die Form zu einem aktiven Starrkörper mit der Masse machen und das Objekt zu ihrem Kind"
    ),
    "Measure the selected objects and copy mass, center and inertia along their own axes as text": (
        "Die ausgewählten Objekte messen und Masse, Mittelpunkt und Trägheit entlang ihrer eigenen Achsen als Text "
        "kopieren"
    ),
    "The capsule of the same mass and center, and of the inertia that comes nearest": (
        "Die Kapsel von gleicher Masse und gleichem Mittelpunkt mit der nächsten Trägheit"
    ),
    "Move origins to the centers of mass and align the local axes with the principal axes, as the physics engine "
    "takes them to be. Nothing visible moves": (
        "Ursprünge in die Massenmittelpunkte bewegen und die lokalen Achsen auf die Hauptträgheitsachsen "
        "ausrichten, wie die Physik es annimmt. Nichts Sichtbares bewegt sich"
    ),
    "Leave the shape of rigid bodies as it is; new ones get a convex hull": (
        "Die Form von Starrkörpern lassen, wie sie ist; neue bekommen eine konvexe Hülle"
    ),
    "Origin at the center of mass, axes along the principal axes, unit scale": (
        "Ursprung im Massenmittelpunkt, Achsen entlang der Hauptträgheitsachsen, Skalierung eins"
    ),
    "What the physics engine takes as center of mass and principal axes": (
        "Was die Physik als Massenmittelpunkt und Hauptachsen nimmt"
    ),
    "Make an object and the selected objects that are parented to it one body with their total mass": (
        "Ein Objekt und die ausgewählten Objekte, die daran hängen, zu einem Körper mit ihrer Gesamtmasse machen"
    ),
    "Make the selected objects rigid bodies: mass from density and true volume, origin at the center of mass, axes "
    "along the principal axes. Nothing visible moves, and joints stay where they are": (
        "Die ausgewählten Objekte zu Starrkörpern machen: Masse aus Dichte und wahrem Volumen, Ursprung im "
        "Massenmittelpunkt, Achsen entlang der Hauptträgheitsachsen. Nichts Sichtbares bewegt sich, und Gelenke "
        "bleiben, wo sie sind"
    ),
    "Update the numbers of the selected objects while they are edited, sculpted, posed or animated, until the file "
    "is closed. In Pose Mode, those of the meshes that the armature deforms. Press Measure to store them": (
        "Die Zahlen der ausgewählten Objekte erneuern, während sie bearbeitet, geformt, gestellt oder animiert "
        "werden, bis die Datei geschlossen wird. Im Posenmodus die der Netze, die die Armatur verformt. Messen "
        "speichert sie"
    ),
    "Each bone of a character is a link in its rest frame, with joints of the bones' limits": (
        "Jeder Knochen einer Figur ist ein Glied in seinem Ruhesystem, mit Gelenken nach den Grenzen der Knochen"
    ),
}
