# SPDX-License-Identifier: GPL-3.0-or-later
"""German."""

TEXTS = {
    # Operators, panels and buttons.
    "Spectral Unwrap": "Spektral abwickeln",
    "Unwrap the mesh with low angle distortion and without pins": (
        "Das Mesh mit geringer Winkelverzerrung und ohne Pins abwickeln"
    ),
    "Select Failed Islands": "Fehlgeschlagene Inseln auswählen",
    "Select the visible faces of the islands that Spectral Unwrap could not solve when they were unwrapped last": (
        "Die sichtbaren Flächen der Inseln auswählen, die „Spektral abwickeln“ beim letzten Abwickeln nicht lösen "
        "konnte"
    ),
    "Select Flipped and Overlapping": "Umgedrehte und überlappende auswählen",
    "Select the visible faces whose UVs lie the wrong way round or on those of other faces, in the active UV map": (
        "Die sichtbaren Flächen auswählen, deren UVs in der aktiven UV-Map verkehrt herum oder auf denen anderer "
        "Flächen liegen"
    ),
    "Suggest Seams": "Nähte vorschlagen",
    "Mark seams that lower the distortion of the map most, and open closed meshes, on the selected faces, or on all "
    "visible ones if none is selected; then unwrap again": (
        "Auf den ausgewählten Flächen, oder auf allen sichtbaren, wenn keine ausgewählt ist, die Nähte markieren, "
        "die die Verzerrung am meisten senken und geschlossene Meshes öffnen; danach neu abwickeln"
    ),
    "Live Spectral Unwrap": "Spektral abwickeln in Echtzeit",
    "Let islands follow while their pins are moved or their extenders change, and unwrap again when seams are "
    "changed": (
        "Inseln folgen, während ihre Pins bewegt oder ihre Extender geändert werden, und werden neu abgewickelt, "
        "wenn sich Nähte ändern"
    ),
    "Extender": "Extender",
    "Select": "Auswählen",
    "Remove": "Entfernen",
    "Add Extender": "Extender hinzufügen",
    "Add forces that push pairs of selected vertices apart in the map, or pull them together": (
        "Kräfte hinzufügen, die Paare ausgewählter Punkte in der UV-Map auseinanderdrücken oder zusammenziehen"
    ),
    "Remove Extender": "Extender entfernen",
    "Remove the active extender": "Den aktiven Extender entfernen",
    "Remove Broken": "Defekte entfernen",
    "Remove all extenders with a vertex that is gone": "Alle Extender entfernen, denen ein Punkt fehlt",
    "Adjust Extender": "Extender anpassen",
    "Change the strength of the active extender by dragging, while its island follows": (
        "Die Stärke des aktiven Extenders durch Ziehen ändern, während seine Insel folgt"
    ),
    "Select Extender Vertices": "Punkte des Extenders auswählen",
    "Select the two vertices of the active extender": "Die beiden Punkte des aktiven Extenders auswählen",
    "Spectral": "Spektral",
    "Seams": "Nähte",
    "Unwrap": "Abwickeln",
    "Settings": "Einstellungen",
    "Advanced": "Erweitert",
    "Last Result": "Letztes Ergebnis",
    "Clear Selected": "Naht löschen",
    "From Islands": "Aus Inseln",
    "Nothing was unwrapped yet": "Noch wurde nichts abgewickelt",
    "Select Island": "Insel auswählen",
    "Select Most Distorted": "Am stärksten verzerrte auswählen",
    "Select the visible faces that the active UV map distorts most": (
        "Die sichtbaren Flächen auswählen, die die aktive UV-Map am stärksten verzerrt"
    ),
    "Inspect Map": "UV-Map untersuchen",
    "Show the numbers of the face below the mouse; a click selects its island": (
        "Die Werte der Fläche unter der Maus anzeigen; ein Klick wählt ihre Insel aus"
    ),
    "Click: Select island   Shift click: Add it   Esc or right click: End": (
        "Klick: Insel auswählen   Umschalt+Klick: Hinzufügen   Esc oder Rechtsklick: Beenden"
    ),
    "Store as Attribute": "Als Attribut speichern",
    "Write what the UV map does to every face into an attribute of the mesh, for rendering, geometry nodes and "
    "scripts": (
        "Was die UV-Map mit jeder Fläche macht, in ein Attribut des Meshs schreiben, für Rendering, Geometry Nodes "
        "und Skripte"
    ),
    "Extenders": "Extender",
    "Add to Active": "Mit dem aktiven verbinden",
    "Vertex gone": "Punkt fehlt",
    # Settings of Spectral Unwrap.
    "Method": "Methode",
    "Unwrapping method": "Methode zum Abwickeln",
    "Weights": "Gewichtungen",
    "How much each triangle counts": "Wie viel jedes Dreieck zählt",
    "Boundary": "Begrenzung",
    "How much each boundary vertex counts": "Wie viel jeder Punkt der Begrenzung zählt",
    "Placement": "Platzierung",
    "Where the unwrapped islands go": "Wohin die abgewickelten Inseln kommen",
    "Turn to Pack": "Zum Packen drehen",
    "Lay islands that are higher than wide on their side to pack them; otherwise all stand upright": (
        "Inseln, die höher als breit sind, zum Packen auf die Seite legen; sonst stehen alle aufrecht"
    ),
    "Fill Holes": "Löcher füllen",
    "Virtually fill holes in mesh before unwrapping, to better avoid overlaps and preserve symmetry": (
        "Löcher im Mesh vor dem Abwickeln virtuell füllen, um Überlappungen besser zu vermeiden und Symmetrie zu "
        "erhalten"
    ),
    "Hole Rigidity": "Steifheit der Löcher",
    "Keep holes open; 1 treats them like the outer border": (
        "Löcher offen halten; 1 behandelt sie wie die äußere Begrenzung"
    ),
    "Automatic Holes": "Automatische Löcher",
    "Keep the holes of an island from shrinking where that lowers its distortion; a Hole Rigidity above 0 takes the "
    "place of this": (
        "Die Löcher einer Insel nicht schrumpfen lassen, wo das ihre Verzerrung senkt; eine „Steifheit der Löcher“ "
        "über 0 tritt an die Stelle davon"
    ),
    "Angle to Area": "Winkel zu Fläche",
    "0 keeps angles, so that sizes vary; towards 1 angles are given up to keep sizes even": (
        "0 erhält Winkel, sodass Größen schwanken; gegen 1 werden Winkel zugunsten gleichmäßiger Größen aufgegeben"
    ),
    "No Flip": "Umdrehen verhindern",
    "Leave no flipped faces, and no island that covers itself: unfold and move apart what is, at some cost in "
    "angles. Islands where that is not enough get another map, which takes longer": (
        "Keine umgedrehten Flächen und keine Insel übrig lassen, die sich selbst überdeckt: solche werden auf Kosten "
        "der Winkel entfaltet und auseinandergeschoben. Inseln, bei denen das nicht reicht, werden auf andere Weise "
        "abgewickelt, was länger dauert"
    ),
    "Polish": "Nachbessern",
    "Lower the angle distortion further by a few steps from the spectral map": (
        "Die Winkelverzerrung ausgehend vom spektralen Ergebnis in einigen Schritten weiter senken"
    ),
    "Edge Stretch": "Kantenstreckung",
    "How much longer the islands get along the direction of the active edge than across it": (
        "Wie viel länger die Inseln in Richtung der aktiven Kante werden als quer dazu"
    ),
    "Show the settings that are seldom changed": "Die Einstellungen anzeigen, die selten geändert werden",
    "Use Subdivision Surface": "Unterteilungsoberfläche verwenden",
    "Map UVs taking vertex position after Subdivision Surface modifier has been applied": (
        "UVs nach den Punktpositionen erzeugen, die der Modifikator „Oberflächenunterteilung“ ergibt"
    ),
    "Soft Pins": "Weiche Pins",
    "Let pinned UVs attract the islands of the spectral method instead of holding them": (
        "Gepinnte UVs ziehen die Inseln der spektralen Methode an, statt sie festzuhalten"
    ),
    "Strength": "Stärke",
    "How strongly soft pins attract, 1000 nearly as if they were held": (
        "Wie stark weiche Pins anziehen, bei 1000 beinahe, als hielten sie fest"
    ),
    "Correct Aspect": "Seitenverhältnis korrigieren",
    "Map UVs taking image aspect ratio into account": (
        "UVs unter Berücksichtigung des Seitenverhältnisses des Bildes erzeugen"
    ),
    "Margin Method": "Randmethode",
    "What the margin is measured by": "Woran der Rand gemessen wird",
    "Margin": "Rand",
    "Space between islands": "Abstand zwischen Inseln",
    # Settings of Suggest Seams.
    "Size Variation": "Größenschwankung",
    "Factor within which the scale of 95 % of the surface is to lie; a larger one takes fewer seams": (
        "Faktor, innerhalb dessen der Maßstab von 95 % der Oberfläche liegen soll; ein größerer kommt mit weniger "
        "Nähten aus"
    ),
    "Angle Distortion": "Winkelverzerrung",
    "Mean quasi-conformal distortion that is not to be exceeded, 1 where all angles are kept; a larger one takes "
    "fewer seams on coarse meshes": (
        "Mittlere quasikonforme Verzerrung, die nicht überschritten werden soll, 1, wo alle Winkel erhalten bleiben; "
        "eine größere kommt auf groben Meshes mit weniger Nähten aus"
    ),
    "Keep Front Clear": "Vorderseite freihalten",
    "How far seams go out of the way of faces that look to the front (the object's -Y), 0 where any side will do": (
        "Wie weit Nähte Flächen ausweichen, die nach vorn zeigen (-Y des Objekts), 0, wenn jede Seite recht ist"
    ),
    "Vertex Group": "Punktgruppe",
    "Painted weights that say where seams are to go or to stay away from; none if empty": (
        "Gemalte Gewichte, die sagen, wo Nähte verlaufen oder wo sie nicht verlaufen sollen; keine, wenn leer"
    ),
    "Group Means": "Bedeutung der Gruppe",
    "What the weights of the vertex group are for": "Wofür die Gewichte der Punktgruppe stehen",
    "No Seams Here": "Hier keine Nähte",
    "The larger the weight, the longer the way round that a seam takes": (
        "Je größer das Gewicht, desto weiter der Umweg, den eine Naht nimmt"
    ),
    "Seams Here": "Hier Nähte",
    "The larger the weight, the rather a seam goes there": "Je größer das Gewicht, desto eher verläuft dort eine Naht",
    "Maximum Length": "Höchstlänge",
    "Limit of the length of all new seams of a mesh, without the object's scale, 0 for none; cuts that closed "
    "islands and handles need are made in any case": (
        "Grenze für die Länge aller neuen Nähte eines Meshs, ohne die Skalierung des Objekts, 0 für keine; Schnitte, "
        "die geschlossene Inseln und Henkel brauchen, werden in jedem Fall gemacht"
    ),
    "Cuts": "Schnitte",
    "Number of the suggested cuts to mark, the most useful first, 0 for all": (
        "Wie viele der vorgeschlagenen Schnitte markiert werden, die nützlichsten zuerst, 0 für alle"
    ),
    "Unwrap the faces afterwards, with the settings with which Spectral Unwrap was used last": (
        "Die Flächen danach abwickeln, mit den zuletzt für „Spektral abwickeln“ benutzten Einstellungen"
    ),
    # Settings of the operators that select and store.
    "Flipped": "Umgedreht",
    "Select faces that lie the other way round than most of their island": (
        "Flächen auswählen, die andersherum liegen als der größte Teil ihrer Insel"
    ),
    "Overlapping": "Überlappend",
    "Select faces that cover part of another face of their island": (
        "Flächen auswählen, die einen Teil einer anderen Fläche ihrer Insel überdecken"
    ),
    "Between Islands": "Zwischen Inseln",
    "Also select faces that cover part of another island, of any mesh in edit mode": (
        "Auch Flächen auswählen, die einen Teil einer anderen Insel überdecken, bei allen Meshes im Bearbeitungsmodus"
    ),
    "Extend": "Erweitern",
    "Add to the selection instead of replacing it": "Zur Auswahl hinzufügen, statt sie zu ersetzen",
    "Islands": "Inseln",
    "The islands of the last result, the worst first": "Die Inseln des letzten Ergebnisses, die schlechtesten zuerst",
    "Island": "Insel",
    "Click an island to select its faces": "Eine Insel anklicken, um ihre Flächen auszuwählen",
    "By": "Nach",
    "What faces are compared by": "Wonach Flächen verglichen werden",
    "Faces whose angles are farthest from those on the surface": (
        "Flächen, deren Winkel am weitesten von denen auf der Oberfläche abweichen"
    ),
    "Size": "Größe",
    "Faces whose size in the map is farthest from that of most of the surface": (
        "Flächen, deren Größe in der UV-Map am weitesten von der des größten Teils der Oberfläche abweicht"
    ),
    "Amount": "Menge",
    "How much of the surface to select, the worst faces first": (
        "Wie viel der Oberfläche ausgewählt wird, die schlechtesten Flächen zuerst"
    ),
    "Above Limit": "Über Grenzwert",
    "Select all that is worse than a limit, however much that is": (
        "Alles auswählen, was schlechter als ein Grenzwert ist, gleich wie viel das ist"
    ),
    "Limit": "Grenzwert",
    "Angle distortion, 1 where angles are kept; or how many times larger or smaller than most faces are": (
        "Winkelverzerrung, 1, wo Winkel erhalten bleiben; oder um welchen Faktor größer oder kleiner als die meisten "
        "Flächen"
    ),
    "Whole Islands": "Ganze Inseln",
    "Compare islands instead of faces, by their average": "Inseln nach ihrem Durchschnitt vergleichen statt Flächen",
    "Store": "Speichern",
    "What to write": "Was geschrieben wird",
    "As Colors": "Als Farben",
    "Write the colors of the overlay to the corners of the faces, instead of one number per face": (
        "Die Farben des Overlays an die Ecken der Flächen schreiben, statt einer Zahl je Fläche"
    ),
    # The overlay that shows the map, and its colours.
    "UV Map Overlay": "UV-Map-Overlay",
    "Show UV Map": "UV-Map anzeigen",
    "Colour the faces by what the active UV map does to them, in the 3D viewport and in the UV editor": (
        "Die Flächen im 3D-Ansichtsfenster und im UV-Editor danach färben, was die aktive UV-Map mit ihnen macht"
    ),
    "Show": "Anzeigen",
    "What the colours stand for": "Wofür die Farben stehen",
    "Own Range": "Eigener Bereich",
    "Set the values of the two ends of the colours by hand; otherwise they follow the map": (
        "Die Werte der beiden Enden der Farbskala von Hand festlegen; sonst richten sie sich nach der UV-Map"
    ),
    "Low": "Niedrig",
    "Value at the lower end of the colours": "Wert am unteren Ende der Farbskala",
    "High": "Hoch",
    "Value at the upper end of the colours": "Wert am oberen Ende der Farbskala",
    "Opacity": "Deckkraft",
    "How much the colours hide of what is below them": "Wie viel die Farben von dem verdecken, was darunter liegt",
    "Image Size": "Bildgröße",
    "Pixels along one side of the image that the texel density is stated for": (
        "Pixel entlang einer Seite des Bildes, für das die Texeldichte angegeben wird"
    ),
    "Squares": "Quadrate",
    "Squares of the checker along one side of a UV tile": (
        "Quadrate des Schachbretts entlang einer Seite einer UV-Kachel"
    ),
    "Legend": "Legende",
    "Show what the colours mean, and the numbers of the map": (
        "Die Bedeutung der Farben und die Werte der UV-Map anzeigen"
    ),
    "Spectral Unwrap Begins With": "„Spektral abwickeln“ beginnt mit",
    "Limits": "Grenzen",
    "Solver": "Löser",
    "{name}, OpenBLAS's kernels for {kernel}": "{name}, OpenBLAS mit den Kernen für {kernel}",
    "Threads": "Threads",
    "How many processor cores a solve may use at once, 0 for all; the map is the same": (
        "Wie viele Prozessorkerne eine Lösung gleichzeitig nutzen darf, 0 für alle; die Map ist dieselbe"
    ),
    "Overlay: Faces": "Overlay: Flächen",
    "Meshes with more faces are not colored, since the overlay follows every edit": (
        "Meshes mit mehr Flächen werden nicht gefärbt, da das Overlay jeder Bearbeitung folgt"
    ),
    "Live Unwrap: Faces": "Echtzeit: Flächen",
    "Meshes with more faces are left alone by Live Spectral Unwrap, which cannot be canceled while it solves": (
        "Meshes mit mehr Flächen werden beim Abwickeln in Echtzeit nicht beachtet, das sich nicht abbrechen lässt, "
        "während es rechnet"
    ),
    "Too many faces to color:": "Zu viele Flächen zum Färben:",
    "The add-on's preferences set the limit": "Grenze: Einstellungen des Add-ons",
    "Too many faces to follow": "Zu viele Flächen für Echtzeit",
    "Colors of the UV Map Overlay": "Farben des UV-Map-Overlays",
    "Angles Kept": "Winkel erhalten",
    "Color of faces whose angles are kept": "Farbe von Flächen, deren Winkel erhalten bleiben",
    "Between": "Dazwischen",
    "Color of faces in the middle of the range": "Farbe von Flächen in der Mitte des Bereichs",
    "Angles Distorted": "Winkel verzerrt",
    "Color of faces at the end of the range and beyond": "Farbe von Flächen am Ende des Bereichs und darüber hinaus",
    "Small": "Klein",
    "Color of faces that are smaller in the map than most": (
        "Farbe von Flächen, die in der UV-Map kleiner sind als die meisten"
    ),
    "Even": "Gleichmäßig",
    "Color of faces of the size of most": "Farbe von Flächen, die so groß sind wie die meisten",
    "Large": "Groß",
    "Color of faces that are larger in the map than most": (
        "Farbe von Flächen, die in der UV-Map größer sind als die meisten"
    ),
    # Extenders.
    "Pairs": "Paare",
    "Which vertices make a pair": "Welche Punkte ein Paar bilden",
    "Above 0 pushes apart, below 0 pulls together; 1 is moderate": (
        "Über 0 drückt auseinander, unter 0 zieht zusammen; 1 ist mäßig"
    ),
    "Index": "Index",
    "Position in the list, -1 for the active extender": "Position in der Liste, -1 für den aktiven Extender",
    "Broken": "Defekt",
    "Remove all extenders with a vertex that is gone instead": (
        "Stattdessen alle Extender entfernen, denen ein Punkt fehlt"
    ),
    "Name": "Name",
    "Name of the extender": "Name des Extenders",
    "Use": "Verwenden",
    "Let the extender act on the next unwrap": "Den Extender auf das nächste Abwickeln wirken lassen",
    "First Vertex": "Erster Punkt",
    "Identifier of its first vertex": "Kennung seines ersten Punktes",
    "Second Vertex": "Zweiter Punkt",
    "Identifier of its second vertex": "Kennung seines zweiten Punktes",
    "Active Extender": "Aktiver Extender",
    "The extender chosen in the panel": "Der im Panel gewählte Extender",
    # What enumerations offer.
    "Least angle distortion with the whole boundary free; no pins": (
        "Geringste Winkelverzerrung bei ganz freier Begrenzung; ohne Pins"
    ),
    "Least Squares": "Kleinste Quadrate",
    "Least squares conformal map, pinned at the two boundary vertices farthest apart": (
        "Konforme Abbildung kleinster Quadrate, an den beiden am weitesten voneinander entfernten Punkten der "
        "Begrenzung gepinnt"
    ),
    "Uniform": "Einheitlich",
    "Every triangle counts by its area": "Jedes Dreieck zählt nach seinem Flächeninhalt",
    "Inverse Area": "Inverser Flächeninhalt",
    "Every triangle counts the same, for irregularly sampled meshes": (
        "Jedes Dreieck zählt gleich viel, für unregelmäßig unterteilte Meshes"
    ),
    "Length": "Länge",
    "Weigh boundary vertices by the length of their boundary edges, whatever the sampling": (
        "Punkte der Begrenzung nach der Länge ihrer Begrenzungskanten gewichten, gleich wie fein sie unterteilt ist"
    ),
    "Vertex": "Punkt",
    "Weigh all boundary vertices equally, as in the original paper": (
        "Alle Punkte der Begrenzung gleich gewichten, wie in der ursprünglichen Veröffentlichung"
    ),
    "Scaled": "Skaliert",
    "Use scale of existing UVs to multiply margin": "Den Rand mit dem Maßstab der vorhandenen UVs multiplizieren",
    "Add": "Hinzufügen",
    "Just add the margin, ignoring any UV scale": "Den Rand nur hinzufügen, ohne auf den Maßstab der UVs zu achten",
    "Fraction": "Bruchteil",
    "Specify a precise fraction of final UV output": "Einen genauen Bruchteil des fertigen UV-Layouts angeben",
    "How far angles are from those on the surface: 1 where they are kept": (
        "Wie weit Winkel von denen auf der Oberfläche abweichen: 1, wo sie erhalten bleiben"
    ),
    "How much larger or smaller faces are in the map than in the middle of it, beside the surface": (
        "Wie viel größer oder kleiner Flächen in der UV-Map im Verhältnis zur Oberfläche sind als in deren Mittel"
    ),
    "Texel Density": "Texeldichte",
    "Pixels of the image along one unit of length on the surface": (
        "Pixel des Bildes entlang einer Längeneinheit auf der Oberfläche"
    ),
    "Flipped and Overlapping": "Umgedreht und überlappend",
    "Faces that lie the wrong way round, or cover others of their island": (
        "Flächen, die verkehrt herum liegen oder andere ihrer Insel überdecken"
    ),
    "Checker": "Schachbrett",
    "Squares of the UV map on the surface, without touching materials": (
        "Quadrate der UV-Map auf der Oberfläche, ohne Materialien anzurühren"
    ),
    "Pack": "Packen",
    "Scale islands by their surface area and pack them into the UV tile, upright": (
        "Inseln nach ihrem Flächeninhalt skalieren und aufrecht in die UV-Kachel packen"
    ),
    "Keep in Place": "An Ort und Stelle",
    "Fit every island into the bounding box that it had before, turned as it was": (
        "Jede Insel in den Hüllquader einpassen, den sie vorher hatte, und so gedreht, wie sie war"
    ),
    "In Order": "Der Reihe nach",
    "Connect the two selected vertices, or of several the first with the second, the third with the fourth and so "
    "on, in the order in which they were selected": (
        "Die beiden ausgewählten Punkte verbinden, oder bei mehreren den ersten mit dem zweiten, den dritten mit dem "
        "vierten und so weiter, in der Reihenfolge, in der sie ausgewählt wurden"
    ),
    "To Active": "Mit dem aktiven",
    "Connect every selected vertex with the active one, which was selected last": (
        "Jeden ausgewählten Punkt mit dem aktiven verbinden, der zuletzt ausgewählt wurde"
    ),
    # What is said of a selection, and why something cannot be done.
    "Select two vertices, or several, one after the other": "Zwei Punkte auswählen, oder mehrere nacheinander",
    "Select the vertices to connect, last the one to connect them with": (
        "Die zu verbindenden Punkte auswählen, zuletzt den, mit dem sie verbunden werden sollen"
    ),
    "No vertex is active; select the one to connect the others with last, with Shift and click": (
        "Kein Punkt ist aktiv; den Punkt, mit dem die anderen verbunden werden sollen, zuletzt mit Umschalt+Klick "
        "auswählen"
    ),
    "The extender has no effect: its vertices lie in no common island; remove the seams between them": (
        "Der Extender wirkt nicht: seine Punkte liegen in keiner gemeinsamen Insel; die Nähte dazwischen entfernen"
    ),
    "The extender has no effect: pins hold its island; unpin it or use soft pins": (
        "Der Extender wirkt nicht: Pins halten seine Insel fest; sie lösen oder weiche Pins verwenden"
    ),
    "Subdivision Surface modifier needs to be first to work with unwrap": (
        "Der Modifikator „Oberflächenunterteilung“ muss an erster Stelle stehen, um beim Abwickeln zu wirken"
    ),
    "Nothing was stretched: there is no active edge; click the edge along which to stretch last": (
        "Nichts wurde gestreckt: es gibt keine aktive Kante; die Kante, in deren Richtung gestreckt werden soll, "
        "zuletzt anklicken"
    ),
    "Adjusting looks at the mesh without its Subdivision Surface modifier; unwrap again to heed it": (
        "Beim Anpassen gilt das Mesh ohne seinen Modifikator „Oberflächenunterteilung“; neu abwickeln, um ihn zu "
        "beachten"
    ),
    "Extenders act with the Spectral method only; unwrap with it": (
        "Extender wirken nur bei der Methode „Spektral“; mit dieser abwickeln"
    ),
    "Nothing is selected; select the vertices to connect, one after the other": (
        "Nichts ist ausgewählt; die zu verbindenden Punkte nacheinander auswählen"
    ),
    "The strength must be a number, not nan": "Die Stärke muss eine Zahl sein, nicht nan",
    "Not enough memory to let the map follow; close other programs, or add seams": (
        "Zu wenig Speicher, um die UV-Map folgen zu lassen; andere Programme schließen oder Nähte hinzufügen"
    ),
    "Not enough memory for it; close other programs, select fewer faces, or add seams": (
        "Zu wenig Speicher dafür; andere Programme schließen, weniger Flächen auswählen oder Nähte hinzufügen"
    ),
    "No such extender; choose one in the list": "Diesen Extender gibt es nicht; einen in der Liste wählen",
    "Enter or click: Confirm   Esc or right click: Cancel   Shift: Precision   Type a number": (
        "Eingabe oder Klick: Bestätigen   Esc oder Rechtsklick: Abbrechen   Umschalt: Genau   Oder eine Zahl tippen"
    ),
    "No faces selected": "Keine Flächen ausgewählt",
    "The meshes changed while they were solved, so nothing was written; unwrap again": (
        "Die Meshes haben sich während der Berechnung geändert, darum wurde nichts geschrieben; neu abwickeln"
    ),
    "Nothing is selected, so all visible faces are unwrapped": (
        "Nichts ist ausgewählt, darum werden alle sichtbaren Flächen abgewickelt"
    ),
    "No visible faces to cut": "Keine sichtbaren Flächen zum Aufschneiden",
    "The meshes changed meanwhile, so nothing was marked; suggest seams again": (
        "Die Meshes haben sich inzwischen geändert, darum wurde nichts markiert; Nähte neu vorschlagen lassen"
    ),
    "Not enough memory, so nothing was changed; close other programs, select fewer faces, or lower the subdivision "
    "levels": (
        "Zu wenig Speicher, darum wurde nichts geändert; andere Programme schließen, weniger Flächen auswählen oder "
        "die Unterteilungsstufen senken"
    ),
    "Failed islands leave too little room in the UV tile, so the others were packed into a tile beside it": (
        "Fehlgeschlagene Inseln lassen zu wenig Platz in der UV-Kachel, darum wurden die anderen in eine Kachel "
        "daneben gepackt"
    ),
    "No unwrap of these meshes is remembered, so none is known to have failed; unwrap first": (
        "Von diesen Meshes ist kein Abwickeln bekannt und darum auch nichts Fehlgeschlagenes; zuerst abwickeln"
    ),
    "Nothing to look for: turn on Flipped or Overlapping": (
        "Nichts zu suchen: „Umgedreht“ oder „Überlappend“ einschalten"
    ),
    "There is no UV map to look at; unwrap first": "Es gibt keine UV-Map zum Ansehen; zuerst abwickeln",
    # How islands with pins were solved: goes into the sentence on them.
    "pinned least squares (LSCM)": "der Methode der kleinsten Quadrate mit festen Pins (LSCM)",
    "the spectral method, pins attracting softly": "der spektralen Methode mit weich anziehenden Pins",
    # Numbers with what they count, and sentences with numbers.
    "{n} cut": "{n} Schnitt",
    "{n} cuts": "{n} Schnitte",
    "{n} extender": "{n} Extender",
    "{n} extenders": "{n} Extender",
    "{n} face": "{n} Fläche",
    "{n} faces": "{n} Flächen",
    "{n} island": "{n} Insel",
    "{n} islands": "{n} Inseln",
    "{operator} is running; Esc cancels it": "„{operator}“ läuft; Esc bricht ab",
    "{operator}: Cancelled": "{operator}: Abgebrochen",
    "{operator}: {percent} %   Esc: Cancel": "{operator}: {percent} %   Esc: Abbrechen",
    "{operator}: {percent} % {phase}   Esc: Cancel": "{operator}: {percent} % {phase}   Esc: Abbrechen",
    "{operator}: {percent} % ({phase})": "{operator}: {percent} % ({phase})",
    "{operator} could not follow: {problem}": "„{operator}“ konnte nicht folgen: {problem}",
    "{name} could not be drawn: {problem}": "„{name}“ konnte nicht gezeichnet werden: {problem}",
    "Unwrapped {islands}: angle distortion beyond measure, as faces shrink to nothing": (
        "{islands} abgewickelt: Winkelverzerrung nicht messbar, da Flächen verschwinden"
    ),
    "{operator} finds where to cut": "{operator} findet Schnitte dafür",
    "Unwrapped {islands}: angle distortion {mean} average, {worst} worst": (
        "{islands} abgewickelt: Winkelverzerrung im Mittel {mean}, höchstens {worst}"
    ),
    "{seconds} s": "{seconds} s",
    "no flipped faces": "keine umgedrehten Flächen",
    "{n} flipped face": "{n} umgedrehte Fläche",
    "{n} flipped faces": "{n} umgedrehte Flächen",
    "{n} overlapping face": "{n} überlappende Fläche",
    "{n} overlapping faces": "{n} überlappende Flächen",
    "{faces} (see {operator})": "{faces} (siehe „{operator}“)",
    # The legend and the list of islands.
    "{factor} x": "{factor} x",
    "sound": "in Ordnung",
    "overlapping": "überlappend",
    "flipped": "umgedreht",
    "{name}: {faces}, nothing to measure": "{name}: {faces}, nichts zu messen",
    "Angles {mean} average, {worst} worst": "Winkel im Mittel {mean}, höchstens {worst}",
    "{name}: {faces}": "{name}: {faces}",
    "Sizes vary by {percent} %": "Größen schwanken um {percent} %",
    "{flipped} flipped, {overlapping} overlapping": "{flipped} umgedreht, {overlapping} überlappend",
    "{n} f.": "{n} Fl.",
    "{n} flipped": "{n} umgedreht",
    "{n} overlap": "{n} überlappen",
    "Not unwrapped   {n} f.": "Nicht abgewickelt   {n} Fl.",
    "The faces of this island have changed since; unwrap again": (
        "Die Flächen dieser Insel haben sich seither geändert; neu abwickeln"
    ),
    "Selected {faces}": "{faces} ausgewählt",
    "{name}: angles {qc}": "{name}: Winkel {qc}",
    "Size {size}, {density} px per unit": "Größe {size}, {density} px je Einheit",
    "Flipped and overlapping": "Umgedreht und überlappend",
    "Stored as {name}": "Als {name} gespeichert",
    "{percent} %": "{percent} %",
    "Shown": "Angezeigt",
    "Active island": "Aktive Insel",
    "Below the mouse": "Unter der Maus",
    # What is said of an unwrap.
    "{n} flipped triangle unfolded": "{n} umgedrehtes Dreieck entfaltet",
    "{n} flipped triangles unfolded": "{n} umgedrehte Dreiecke entfaltet",
    "{n} island needed the slower fallback map": "{n} Insel musste auf die langsamere andere Weise abgewickelt werden",
    "{n} islands needed the slower fallback map": (
        "{n} Inseln mussten auf die langsamere andere Weise abgewickelt werden"
    ),
    "No Flip: {changes}": "Umdrehen verhindern: {changes}",
    "No Flip: {changes}; their angle distortion {before} before, {after} after": (
        "Umdrehen verhindern: {changes}; Winkelverzerrung dort vorher {before}, nachher {after}"
    ),
    "{n} island has faces stretched to more than twice their width, {worst} at worst; add seams there": (
        "{n} Insel hat Flächen, die auf mehr als das Doppelte ihrer Breite gestreckt sind, schlimmstens {worst}; dort "
        "Nähte hinzufügen"
    ),
    "{n} islands have faces stretched to more than twice their width, {worst} at worst; add seams there": (
        "{n} Inseln haben Flächen, die auf mehr als das Doppelte ihrer Breite gestreckt sind, schlimmstens {worst}; "
        "dort Nähte hinzufügen"
    ),
    "{n} face shrinks below what Blender's UV coordinates resolve; add seams that make the island flatter, or raise "
    "Angle to Area": (
        "{n} Fläche schrumpft unter das, was Blenders UV-Koordinaten auflösen; Nähte hinzufügen, die die Insel "
        "flacher machen, oder „Winkel zu Fläche“ erhöhen"
    ),
    "{n} faces shrink below what Blender's UV coordinates resolve; add seams that make the island flatter, or raise "
    "Angle to Area": (
        "{n} Flächen schrumpfen unter das, was Blenders UV-Koordinaten auflösen; Nähte hinzufügen, die die Insel "
        "flacher machen, oder „Winkel zu Fläche“ erhöhen"
    ),
    "{failed} of {islands} failed, UVs unchanged: {reasons}": (
        "{failed} von {islands} fehlgeschlagen, UVs unverändert: {reasons}"
    ),
    "Not unwrapped: {reasons}": "Nicht abgewickelt: {reasons}",
    "{n} island needed a repair or fallback: {reasons}": (
        "{n} Insel musste repariert oder anders abgewickelt werden: {reasons}"
    ),
    "{n} islands needed a repair or fallback: {reasons}": (
        "{n} Inseln mussten repariert oder anders abgewickelt werden: {reasons}"
    ),
    "{n} island with pins: solved by {ways}": "{n} Insel mit Pins: gelöst mit {ways}",
    "{n} islands with pins: solved by {ways}": "{n} Inseln mit Pins: gelöst mit {ways}",
    "Object has non-uniform scale, unwrap will operate on a non-scaled version of the mesh": (
        "Das Objekt ist ungleichmäßig skaliert; abgewickelt wird das Mesh ohne Skalierung"
    ),
    "Object has negative scale, unwrap will operate on a non-flipped version of the mesh": (
        "Das Objekt ist negativ skaliert; abgewickelt wird das Mesh ohne Spiegelung"
    ),
    # Extenders.
    "Skipped {n} extender whose vertex is gone: {names}": "{n} Extender übersprungen, dem ein Punkt fehlt: {names}",
    "Skipped {n} extenders whose vertex is gone: {names}": "{n} Extender übersprungen, denen ein Punkt fehlt: {names}",
    "Skipped {n} extender whose strength is no number that it can have: {names}": (
        "{n} Extender übersprungen, dessen Stärke kein zulässiger Wert ist: {names}"
    ),
    "Skipped {n} extenders whose strength is no number that it can have: {names}": (
        "{n} Extender übersprungen, deren Stärke kein zulässiger Wert ist: {names}"
    ),
    "{name} is broken: a vertex of it is gone; remove it and add another": (
        "{name} ist defekt: ein Punkt davon fehlt; entfernen und einen anderen hinzufügen"
    ),
    "{operator}: strength {strength}   {note}": "{operator}: Stärke {strength}   {note}",
    "Removed broken extenders: {n}": "Defekte Extender entfernt: {n}",
    "{name} is broken: {n} of its vertices gone; remove it": "{name} ist defekt: fehlende Punkte: {n}; entfernen",
    "{name} has hidden vertices: {n}; reveal them to select them": (
        "{name} hat verborgene Punkte: {n}; einblenden, um sie auszuwählen"
    ),
    "Added {extenders}": "{extenders} hinzugefügt",
    "Added {extenders}, which will act on the next unwrap; {operator} acts at once": (
        "{extenders} hinzugefügt, mit Wirkung auf das nächste Abwickeln; „{operator}“ wirkt sofort"
    ),
    "Pairs that have an extender already: {n}": "Paare, die schon einen Extender haben: {n}",
    "{n} extender had no effect: both vertices must lie in one unwrapped island, which pins must not hold": (
        "{n} Extender hatte keine Wirkung: beide Punkte müssen in einer abgewickelten Insel liegen, die keine Pins "
        "festhalten"
    ),
    "{n} extenders had no effect: both vertices must lie in one unwrapped island, which pins must not hold": (
        "{n} Extender hatten keine Wirkung: beide Punkte müssen in einer abgewickelten Insel liegen, die keine Pins "
        "festhalten"
    ),
    # What is said of what was selected.
    "No islands failed, selection unchanged": "Keine Insel ist fehlgeschlagen, Auswahl unverändert",
    "{n} failed island": "{n} fehlgeschlagenen Insel",
    "{n} failed islands": "{n} fehlgeschlagenen Inseln",
    "Selected {faces} of {islands}": "{faces} von {islands} ausgewählt",
    "Faces were added, removed or reordered since the last unwrap of {names}; unwrap again": (
        "Seit dem letzten Abwickeln von {names} wurden Flächen hinzugefügt, entfernt oder umgeordnet; neu abwickeln"
    ),
    "No flipped or overlapping faces, selection unchanged": (
        "Keine umgedrehten oder überlappenden Flächen, Auswahl unverändert"
    ),
    "No flipped faces, selection unchanged": "Keine umgedrehten Flächen, Auswahl unverändert",
    "No overlapping faces, selection unchanged": "Keine überlappenden Flächen, Auswahl unverändert",
    "{n} overlapping": "{n} überlappend",
    "{n} with UVs that are not finite": "{n} mit nicht endlichen UVs",
    "Selected {faces}: {kinds}": "{faces} ausgewählt: {kinds}",
    # Suggested seams.
    "Marked {cuts} of length {length}": "{cuts} der Länge {length} markiert",
    "No seams to suggest: the islands are even enough already, or no cut makes them better, or none within the "
    "length": (
        "Keine Nähte vorzuschlagen: die Inseln sind schon gleichmäßig genug, oder kein Schnitt macht sie besser, "
        "oder keiner innerhalb der Länge"
    ),
    "No seams to suggest: the islands are even enough already, or no cut makes them better": (
        "Keine Nähte vorzuschlagen: die Inseln sind schon gleichmäßig genug, oder kein Schnitt macht sie besser"
    ),
    "No seams suggested for {meshes}": "Keine Nähte vorgeschlagen für {meshes}",
    "{cuts}, length {length}": "{cuts}, Länge {length}",
    "{n} of {cuts}, length {length} of {total}": "{cuts}, davon gezeigt: {n}, Länge {length} von {total}",
    "Wheel, +/-, Page keys: Fewer or more   Enter or click: Apply   Esc or right click: Cancel": (
        "Mausrad, +/-, Bild auf/ab: Weniger oder mehr   Eingabe oder Klick: Anwenden   Esc oder Rechtsklick: Abbrechen"
    ),
    "{operator}: {known}   {keys}": "{operator}: {known}   {keys}",
    "{percent} of the surface within {factor} times the median scale (now {now})": (
        "{percent} der Oberfläche innerhalb des Faktors {factor} um den mittleren Maßstab (jetzt {now})"
    ),
    "{percent} of the surface within {factor} times the median scale, angle distortion {qc} (now {now})": (
        "{percent} der Oberfläche innerhalb des Faktors {factor} um den mittleren Maßstab, Winkelverzerrung {qc} "
        "(jetzt {now})"
    ),
    # What does not run.
    "The compiled module spectral_conformal cannot be imported; install the package of Spectral Unwrap made for this "
    "platform and this version of Blender ({reason})": (
        "Das kompilierte Modul spectral_conformal lässt sich nicht importieren; das Paket von Spectral Unwrap für "
        "dieses System und diese Version von Blender installieren ({reason})"
    ),
    "The margin must be a number, not {margin}": "Der Rand muss eine Zahl sein, nicht {margin}",
    "Extender without a name": "Extender ohne Namen",
    "{n} vertices are selected, {unordered} of them in no order; select them one after the other with Shift and "
    "click, or use {operator}": (
        "{n} Punkte sind ausgewählt, davon ohne Reihenfolge: {unordered}; sie nacheinander mit Umschalt+Klick "
        "auswählen oder „{operator}“ benutzen"
    ),
    "{n} vertices are selected, so one has no partner; select an even number": (
        "{n} Punkte sind ausgewählt, darum hat einer keinen Partner; eine gerade Anzahl auswählen"
    ),
    "{n} island had no UV bounds to keep and was laid out in the unit square": (
        "{n} Insel hatte keinen UV-Bereich zum Beibehalten und wurde ins Einheitsquadrat gelegt"
    ),
    "{n} islands had no UV bounds to keep and were laid out side by side in the unit square": (
        "{n} Inseln hatten keinen UV-Bereich zum Beibehalten und wurden nebeneinander ins Einheitsquadrat gelegt"
    ),
}
