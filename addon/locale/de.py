# SPDX-License-Identifier: GPL-3.0-or-later
"""German."""

TEXTS = {
    # Operators, panels and buttons.
    "Spectral Unwrap": "Spektral abwickeln",
    "Unwrap the selected faces with low angle distortion; no pins are needed": (
        "Die ausgewählten Flächen mit geringer Winkelverzerrung abwickeln; Pins sind nicht nötig"
    ),
    "Spectral Relax": "Spektral entspannen",
    "Relax": "Entspannen",
    "Even out the existing UV map, without new flips or overlaps. Only selected faces move; UVs that they share with "
    "others stay. Without a selection, all visible faces move": (
        "Die vorhandene UV-Map ausgleichen, ohne neue umgedrehte oder überlappende Flächen. Nur ausgewählte Flächen "
        "bewegen sich, mit anderen geteilte UVs bleiben; ohne Auswahl bewegen sich alle sichtbaren"
    ),
    "Spectral Pack": "Spektral packen",
    "Pack the selected islands into the UV tile by their true shapes, holes included, around everything that stays. "
    "The packing gets denser in the view until you end it. Without a selection, all visible islands are packed": (
        "Die ausgewählten Inseln nach ihren wahren Formen, auch in Löcher, in die UV-Kachel packen, um alles herum, "
        "was bleibt. In der Ansicht wird immer dichter gepackt, bis man es beendet. Ohne Auswahl werden alle "
        "sichtbaren Inseln gepackt"
    ),
    "Arrange Islands": "Inseln aufreihen",
    "Put the selected islands side by side, sorted by size, with the margin between them. Without a selection, all "
    "visible islands are arranged": (
        "Die ausgewählten Inseln nach Größe geordnet nebeneinanderlegen, mit dem Rand dazwischen. Ohne Auswahl werden "
        "alle sichtbaren Inseln aufgereiht"
    ),
    "Axis": "Achse",
    "Direction in which the islands follow each other": "Richtung, in der die Inseln aufeinanderfolgen",
    "Row": "Reihe",
    "A row along U": "Eine Reihe entlang U",
    "Column": "Spalte",
    "A column along V": "Eine Spalte entlang V",
    "Order": "Reihenfolge",
    "Order of the islands, by the area of their bounding boxes": (
        "Reihenfolge der Inseln nach der Fläche ihrer Begrenzungsrahmen"
    ),
    "Largest First": "Größte zuerst",
    "From the largest island to the smallest": "Von der größten Insel zur kleinsten",
    "Smallest First": "Kleinste zuerst",
    "From the smallest island to the largest": "Von der kleinsten Insel zur größten",
    "UV Tile": "UV-Kachel",
    "Stitch": "Vernähen",
    "Weld": "Verschweißen",
    "Select Similar": "Ähnliche auswählen",
    "Blender does not tell add-ons its Custom Region; to fill a part of the tile, pack to a Box": (
        "Blender verrät Add-ons seine benutzerdefinierte Region nicht; in ein Rechteck packen, um einen Teil der "
        "Kachel zu füllen"
    ),
    "Arranged {islands}": "{islands} aufgereiht",
    "Pixels of the texture between islands, and between them and the border of the tile": (
        "Pixel der Textur zwischen Inseln, und zwischen ihnen und der Grenze der Kachel"
    ),
    "Pixels along one side of the texture, for the margin; 0 takes the size of the material's texture or, if it has "
    "none, the scene's": (
        "Pixel entlang einer Seite der Textur, für den Rand; 0 nimmt die Größe der Textur des Materials oder, wenn es "
        "keine hat, die der Szene"
    ),
    "Texture": "Textur",
    "New UV Map and Textures": "Neue UV-Map und Texturen",
    "Unwrap whole meshes to a new UV map, and draw every image texture that reads the active map anew for it, so that "
    "all looks the same. The old map and images stay. Without marked seams, islands end where those of the active map "
    "do": (
        "Ganze Meshes zu einer neuen UV-Map abwickeln und jede Bildtextur, die die aktive Map liest, neu für sie "
        "zeichnen, so dass alles gleich aussieht. Die alte Map und die Bilder bleiben. Ohne markierte Nähte enden "
        "Inseln, wo die der aktiven Map enden"
    ),
    "New Textures": "Neue Texturen",
    "The size of the new textures": "Die Größe der neuen Texturen",
    "As Before": "Wie bisher",
    "Each texture keeps its size": "Jede Textur behält ihre Größe",
    "The texture size of the scene": "Die Texturgröße der Szene",
    "No Loss": "Ohne Verlust",
    "The texture size of the scene, doubled until no detail is lost": (
        "Die Texturgröße der Szene, verdoppelt, bis keine Einzelheiten verloren gehen"
    ),
    "Meshes or materials changed meanwhile, so nothing was written; call it again": (
        "Meshes oder Materialien haben sich inzwischen geändert, daher wurde nichts geschrieben; bitte erneut aufrufen"
    ),
    "There is no room for a new UV map: remove one of the eight first": (
        "Es ist kein Platz für eine neue UV-Map: Zuerst eine der acht entfernen"
    ),
    "Drawing textures": "Zeichne Texturen",
    "{n} texture": "{n} Textur",
    "{n} textures": "{n} Texturen",
    "New UV map {uv_map} with {islands}; {textures} drawn for it; {seconds} s": (
        "Neue UV-Map {uv_map} mit {islands}; {textures} für sie gezeichnet; {seconds} s"
    ),
    "a sequence, a movie or tiles": "eine Folge, ein Film oder Kacheln",
    "missing": "fehlt",
    "not projected by a UV map alone": "nicht durch eine UV-Map allein projiziert",
    "moved by other nodes": "durch andere Nodes verschoben",
    "in a node group": "in einer Node-Gruppe",
    "Not drawn anew, so keep the old UV map or bake these: {names}": (
        "Nicht neu gezeichnet, also die alte UV-Map behalten oder diese backen: {names}"
    ),
    "{name}: {reason}": "{name}: {reason}",
    "{name} {factor} times": "{name} {factor}-mal",
    "Coarser than before, so choose a larger size: {names}": (
        "Gröber als bisher, also eine größere Größe wählen: {names}"
    ),
    "Copied, because other objects have these materials, too: {names}": (
        "Kopiert, weil auch andere Objekte diese Materialien haben: {names}"
    ),
    "1k": "1k",
    "2k": "2k",
    "4k": "4k",
    "Nothing packed yet": "Noch nichts gepackt",
    "Last packing: {percent}": "Zuletzt gepackt: {percent}",
    "Of the material: {side} px": "Des Materials: {side} px",
    "Pixels along one side of the texture, for margins and texel densities; a material's image, or the size entered "
    "for it, goes before": (
        "Pixel entlang einer Seite der Textur, für Ränder und Texeldichten; das Bild eines Materials oder die dort "
        "eingetragene Größe geht vor"
    ),
    "Texture of Material": "Textur des Materials",
    "Rotation": "Drehung",
    "How islands may turn": "Wie Inseln sich drehen dürfen",
    "Scale all islands alike to fill the tile; otherwise they keep their size, where there is room": (
        "Alle Inseln gleich skalieren, um die Kachel zu füllen; sonst behalten sie ihre Größe, solange Platz ist"
    ),
    "Smallest Island": "Kleinste Insel",
    "Enlarge islands until their longer side has this many pixels; 0 keeps all at one scale": (
        "Inseln vergrößern, bis ihre längere Seite so viele Pixel hat; 0 lässt alle in einem Maßstab"
    ),
    "Whole Pixels": "Ganze Pixel",
    "Move straight borders of islands to the borders of pixels, at most half a pixel, for lightmaps": (
        "Gerade Ränder von Inseln auf die Grenzen von Pixeln schieben, um höchstens ein halbes Pixel, für Lightmaps"
    ),
    "Stacks": "Stapel",
    "Islands that lie on each other and share their texture": "Inseln, die aufeinanderliegen und ihre Textur teilen",
    "Hold Pinned": "Gepinnte festhalten",
    "Islands with a pinned UV stay where they are, and the others are packed around them": (
        "Inseln mit einer gepinnten UV bleiben, wo sie sind, und die anderen werden um sie herum gepackt"
    ),
    "Groups": "Gruppen",
    "Islands that move as one and keep their arrangement": (
        "Inseln, die sich als Ganzes bewegen, sodass ihre Anordnung bleibt"
    ),
    "Each island moves on its own": "Jede Insel bewegt sich für sich",
    "By Object": "Nach Objekt",
    "The islands of an object move as one": "Die Inseln eines Objekts bewegen sich als Ganzes",
    "By Material": "Nach Material",
    "Islands with the same material move as one": "Inseln mit demselben Material bewegen sich als Ganzes",
    "Pack to": "Packen in",
    "What to fill": "Was gefüllt wird",
    "Box from": "Rechteck von",
    "U and V of the lower left corner": "U und V der unteren linken Ecke",
    "Box to": "Rechteck bis",
    "U and V of the upper right corner": "U und V der oberen rechten Ecke",
    "Number of Tiles": "Anzahl der Kacheln",
    "UDIM tiles to fill, from the active one on": "Zu füllende UDIM-Kacheln, von der aktiven an",
    "Seconds": "Sekunden",
    "How long the search goes on in the view, unless you end it": (
        "Wie lange die Suche in der Ansicht dauert, wenn man sie nicht vorher beendet"
    ),
    "Arrangements to try after the first; the densest is kept": (
        "Anordnungen, die nach der ersten versucht werden; die dichteste bleibt"
    ),
    "Straight Upright": "Gerade aufrecht",
    "Straight islands stand upright, in quarter turns; the others turn by any angle": (
        "Gerade Inseln stehen aufrecht, in Vierteldrehungen; die anderen drehen sich um jeden Winkel"
    ),
    "Free": "Frei",
    "By any angle, which fills the most": "Um jeden Winkel, was am meisten füllt",
    "Quarter Turns": "Vierteldrehungen",
    "Upright": "Aufrecht",
    "Straighten islands that lean, and turn them by quarter turns": (
        "Schräge Inseln aufrichten und um Vierteldrehungen drehen"
    ),
    "By quarter turns; straight islands stay straight, and leaning ones leaning": (
        "Um Vierteldrehungen: Gerade Inseln bleiben gerade, schräge schräg"
    ),
    "None": "Keine",
    "Not at all": "Gar nicht",
    "Scale": "Skalieren",
    "Apart": "Getrennt",
    "All islands lie apart": "Alle Inseln liegen getrennt",
    "Keep": "Behalten",
    "Equal islands that lie on each other stay stacked": "Gleiche Inseln, die aufeinanderliegen, bleiben gestapelt",
    "Keep Overlaps": "Überlappende behalten",
    "Islands that overlap stay together, whatever their shapes": (
        "Inseln, die sich überlappen, bleiben beisammen, welche Form sie auch haben"
    ),
    "Equal": "Gleich",
    "Stack equal islands": "Gleiche Inseln stapeln",
    "Equal or Mirrored": "Gleich oder gespiegelt",
    "Stack equal and mirrored islands; the latter are mirrored to match": (
        "Gleiche und gespiegelte Inseln stapeln; die gespiegelten werden dafür umgekehrt"
    ),
    "Own Tiles": "Eigene Kacheln",
    "Each island stays in its UV tile": "Jede Insel bleibt in ihrer UV-Kachel",
    "Active Tile": "Aktive Kachel",
    "The active UDIM tile of the image in the UV editor, or the first one": (
        "Die aktive UDIM-Kachel des Bildes im UV-Editor, oder die erste"
    ),
    "Bounding Box": "Begrenzungsrahmen",
    "The bounding box of the islands as they are": "Der Begrenzungsrahmen der Inseln, wie sie liegen",
    "Box": "Rechteck",
    "A rectangle of your choice, such as a quarter of the tile": (
        "Ein Rechteck nach Wahl, etwa ein Viertel der Kachel"
    ),
    "Several Tiles": "Mehrere Kacheln",
    "A number of UDIM tiles, from the active one on": "Eine Anzahl von UDIM-Kacheln, von der aktiven an",
    "As Many as Needed": "So viele wie nötig",
    "UDIM tiles from the active one on, as few as islands of this size need; islands keep their size": (
        "UDIM-Kacheln von der aktiven an, so wenige, wie Inseln dieser Größe brauchen; Inseln behalten ihre Größe"
    ),
    "Nothing can move: all selected islands are pinned": (
        "Nichts kann sich bewegen: Alle ausgewählten Inseln sind gepinnt"
    ),
    "Packed {islands}": "{islands} gepackt",
    "Kept {islands} as packed; no denser packing found": "{islands} bleiben so gepackt; nichts Dichteres gefunden",
    "{count} stacked on others": "{count} auf andere gestapelt",
    "{n} pinned island stays where it is": "{n} gepinnte Insel bleibt, wo sie ist",
    "{n} pinned islands stay where they are": "{n} gepinnte Inseln bleiben, wo sie sind",
    "{count} of {islands} found no room; turn on Scale, lower the margin or fill more tiles": (
        "{count} von {islands} fanden keinen Platz; „Skalieren“ einschalten, den Rand verringern oder mehr Kacheln "
        "füllen"
    ),
    "Islands of this size do not fit into a tile; make them or the margin smaller": (
        "Inseln dieser Größe passen nicht in eine Kachel; sie oder den Rand verkleinern"
    ),
    "A margin of {margin} px leaves no room within {side} px": (
        "Ein Rand von {margin} px lässt innerhalb von {side} px keinen Platz"
    ),
    "{operator}: packing   {keys}": "{operator}: packt   {keys}",
    "{operator}: {fill} after {steps}   {keys}": "{operator}: {fill} nach {steps}   {keys}",
    "Enter or click: Keep   Esc or right click: Restore": (
        "Eingabe oder Klick: Behalten   Esc oder Rechtsklick: Wiederherstellen"
    ),
    "Select Failed Islands": "Fehlgeschlagene Inseln auswählen",
    "Spectral Select": "Spektral auswählen",
    "Select faces by the active UV map, or by the last unwrap": (
        "Flächen nach der aktiven UV-Map oder der letzten Abwicklung auswählen"
    ),
    "Which of the visible faces to select": "Welche der sichtbaren Flächen ausgewählt werden",
    "Faces that the map distorts most, or beyond a limit": (
        "Flächen, die die UV-Map am stärksten oder jenseits einer Grenze verzerrt"
    ),
    "Stretched Faces": "Gestreckte Flächen",
    "Faces that the map stretches to more than twice their width": (
        "Flächen, die die UV-Map auf mehr als das Doppelte ihrer Breite streckt"
    ),
    "Failed Islands": "Fehlgeschlagene Inseln",
    "Islands that the last unwrap could not solve, or the edges whose shapes contradict each other": (
        "Inseln, die zuletzt nicht abgewickelt werden konnten, oder die Kanten, deren Formen einander widersprechen"
    ),
    "Selected {n} edge whose shapes contradict each other": (
        "{n} Kante ausgewählt, deren Formen einander widersprechen"
    ),
    "Selected {n} edges whose shapes contradict each other": (
        "{n} Kanten ausgewählt, deren Formen einander widersprechen"
    ),
    "Select Flipped and Overlapping": "Umgedrehte und überlappende auswählen",
    "Suggest Seams": "Nähte vorschlagen",
    "Mark the seams that lower distortion most and open closed meshes, on the selected faces or, without a "
    "selection, on all visible ones; then unwrap": (
        "Auf den ausgewählten Flächen, ohne Auswahl auf allen sichtbaren, die Nähte markieren, die die Verzerrung "
        "am meisten senken und geschlossene Meshes öffnen; danach abwickeln"
    ),
    "Spectral Shape": "Spektral formen",
    "Make the selected part of the map straight, rectangular, a grid, symmetric or upright, or push it": (
        "Den ausgewählten Teil der UV-Map gerade, rechteckig, zum Raster, symmetrisch oder aufrecht machen oder ihn "
        "drücken"
    ),
    "Shape": "Form",
    "Shapes": "Formen",
    "What the selection becomes": "Was aus der Auswahl wird",
    "Straight": "Gerade",
    "Keep the selected edges straight in the map, exactly and without pins": (
        "Die ausgewählten Kanten in der UV-Map gerade halten, genau und ohne Pins"
    ),
    "Rectangle": "Rechteck",
    "Keep the selected faces or islands rectangular; four selected vertices on an island's border become its corners, "
    "otherwise the sharpest ones do": (
        "Die ausgewählten Flächen oder Inseln rechteckig halten; vier ausgewählte Punkte am Rand einer Insel werden "
        "ihre Ecken, sonst die spitzesten"
    ),
    "Grid": "Raster",
    "Keep the rows and columns of the selected quads straight in the map": (
        "Die Zeilen und Spalten der ausgewählten Vierecke in der UV-Map gerade halten"
    ),
    "Symmetric": "Symmetrisch",
    "Make both sides of the selected edges mirror images in the map, with the edges upright; if faces are selected, "
    "the mirror plane of their islands is the axis": (
        "Beide Seiten der ausgewählten Kanten in der UV-Map spiegelgleich halten, mit aufrechten Kanten; sind Flächen "
        "ausgewählt, ist die Spiegelebene ihrer Inseln die Achse"
    ),
    "Turn the selected islands upright, by their edges or by an axis of the mesh; without a selection, all islands": (
        "Die ausgewählten Inseln aufrichten, nach ihren Kanten oder einer Achse des Meshs; ohne Auswahl alle"
    ),
    "What islands are turned by": "Wonach Inseln gedreht werden",
    "Most Edges": "Meiste Kanten",
    "Most edges become horizontal or vertical, whichever is nearer": (
        "Die meisten Kanten werden horizontal oder vertikal, je nachdem, was näher ist"
    ),
    "Selected Edges": "Ausgewählte Kanten",
    "The selected edges become horizontal or vertical, whichever is nearer": (
        "Die ausgewählten Kanten werden horizontal oder vertikal, je nachdem, was näher ist"
    ),
    "Mesh Z": "Z des Meshs",
    "What is higher on the mesh is higher in the map": "Was auf dem Mesh höher liegt, liegt in der UV-Map höher",
    "Mesh Y": "Y des Meshs",
    "What is farther along Y is higher in the map": "Was auf dem Mesh weiter in Y liegt, liegt in der UV-Map höher",
    "Mesh X": "X des Meshs",
    "What is farther along X is higher in the map": "Was auf dem Mesh weiter in X liegt, liegt in der UV-Map höher",
    "{n} island turned upright": "{n} Insel aufgerichtet",
    "{n} islands turned upright": "{n} Inseln aufgerichtet",
    "All islands are upright already": "Alle Inseln stehen schon aufrecht",
    "Remove Shape": "Form entfernen",
    "Remove this shape from the list, which no longer binds the map": (
        "Diese Form aus der Liste entfernen; sie bindet die UV-Map nicht mehr"
    ),
    "Index": "Index",
    "Place in the list; -1 for the active one": "Platz in der Liste; -1 für die aktive",
    "Straight {number}": "Gerade {number}",
    "Rectangle {number}": "Rechteck {number}",
    "Grid {number}": "Raster {number}",
    "Symmetric {number}": "Symmetrisch {number}",
    "Unwrap the islands at once, in place": "Die Inseln sofort vor Ort abwickeln",
    "Direction": "Richtung",
    "How the edges lie in the map": "Wie die Kanten in der UV-Map liegen",
    "Nearest": "Nächste",
    "Horizontal or vertical, as each chain of edges lies now": (
        "Horizontal oder vertikal, je nachdem, wie jede Kette von Kanten jetzt liegt"
    ),
    "Horizontal": "Horizontal",
    "All horizontal": "Alle horizontal",
    "Vertical": "Vertikal",
    "All vertical": "Alle vertikal",
    "As It Lies": "Wie sie liegt",
    "Each chain of edges keeps its angle": "Jede Kette von Kanten behält ihren Winkel",
    "Spacing": "Abstände",
    "The widths of the columns and the heights of the rows": "Die Breiten der Spalten und die Höhen der Zeilen",
    "Least Distortion": "Geringste Verzerrung",
    "The unwrap chooses them": "Das Abwickeln bestimmt sie",
    "By Length": "Nach Länge",
    "Proportional to the lengths of the edges on the mesh": "Im Verhältnis der Kantenlängen auf dem Mesh",
    "All columns equally wide, and all rows equally high": "Alle Spalten gleich breit und alle Zeilen gleich hoch",
    "Edges on a seam lie at another angle in each island; straighten them horizontally or vertically": (
        "Kanten auf einer Naht liegen in jeder Insel in einem anderen Winkel; horizontal oder vertikal begradigen"
    ),
    "Nothing selected; select faces, or the four corners of an island": (
        "Nichts ausgewählt; Flächen oder die vier Ecken einer Insel auswählen"
    ),
    "No quads selected; select quads that form a grid": (
        "Keine Vierecke ausgewählt; Vierecke auswählen, die ein Raster bilden"
    ),
    "These quads do not form a grid; leave out those around vertices where three, or five or more, of them meet": (
        "Diese Vierecke bilden kein Raster; die um Punkte weglassen, an denen nicht vier zusammentreffen"
    ),
    "To become a rectangle, an island needs a single border, with four or more vertices, and no holes": (
        "Um ein Rechteck zu werden, braucht eine Insel einen einzigen Rand mit mindestens vier Punkten und kein Loch"
    ),
    "Some seams would have to be horizontal on one side and vertical on the other; select fewer islands": (
        "Manche Nähte müssten auf einer Seite horizontal und auf der anderen vertikal sein; weniger Inseln auswählen"
    ),
    "{problem}; {n} part stays as it is, now selected": "{problem}; {n} Teil bleibt, wie er ist, und ist ausgewählt",
    "{problem}; {n} parts stay as they are, now selected": (
        "{problem}; {n} Teile bleiben, wie sie sind, und sind ausgewählt"
    ),
    "No mirror plane found; select the edges along the axis of symmetry": (
        "Keine Spiegelebene gefunden; die Kanten auswählen, an denen sich beide Seiten spiegeln sollen"
    ),
    "{n} pair of islands mirrors each other: both are mapped alike, without an axis": (
        "{n} Inselpaar ist spiegelbildlich: Beide Inseln werden gleich abgewickelt, ohne Achse"
    ),
    "{n} pairs of islands mirror each other: both of a pair are mapped alike, without an axis": (
        "{n} Inselpaare sind spiegelbildlich: Beide Inseln eines Paares werden gleich abgewickelt, ohne Achse"
    ),
    "No visible face has these edges, so nothing was unwrapped": (
        "Keine sichtbare Fläche hat diese Kanten, deshalb wurde nichts abgewickelt"
    ),
    "Nothing was unwrapped, so nothing was stored": "Nichts wurde abgewickelt, darum wurde nichts gespeichert",
    "{operator}: {edges} marked; unwrap to see it": "{operator}: {edges} markiert; zum Anzeigen abwickeln",
    "Hold the Rest": "Rest festhalten",
    (
        "If only a part of an island is selected, keep its border with the unselected faces fixed; when disabled, cut "
        "the part off"
    ): (
        "Wenn nur ein Teil einer Insel ausgewählt ist, seine Grenze zu den nicht ausgewählten Flächen festhalten; wenn "
        "ausgeschaltet, den Teil abtrennen"
    ),
    "Move": "Verschieben",
    "Which coordinates change": "Welche Koordinaten sich ändern",
    "Blend": "Überblendung",
    "0 keeps the map as it was, 1 is the unwrapped one": "0 behält die UV-Map, wie sie war, 1 ist die abgewickelte",
    "U and V": "U und V",
    "Both coordinates change": "Beide Koordinaten ändern sich",
    "U Only": "Nur U",
    "U changes, V stays as it is": "U ändert sich, V bleibt",
    "V Only": "Nur V",
    "V changes, U stays as it is": "V ändert sich, U bleibt",
    "{n} part of an island solved in place; {uvs} shared with the rest stayed": (
        "{n} Teil einer Insel vor Ort gelöst; {uvs}, die er mit dem Rest teilt, unverändert"
    ),
    "{n} parts of islands solved in place; {uvs} shared with the rest stayed": (
        "{n} Teile von Inseln vor Ort gelöst; {uvs}, die sie mit dem Rest teilen, unverändert"
    ),
    "{n} UV": "{n} UV",
    "{n} UVs": "{n} UVs",
    "Nothing moved in {n} part of an island: unselected faces share all UVs; select more or turn off Hold the Rest": (
        "{n} Teil einer Insel teilt jede UV mit nicht ausgewählten Flächen, also bewegte sich nichts; mehr auswählen "
        "oder „Rest festhalten“ ausschalten"
    ),
    "Nothing moved in {n} parts of islands: unselected faces share all UVs; select more or turn off Hold the Rest": (
        "{n} Teile von Inseln teilen jede UV mit nicht ausgewählten Flächen, also bewegte sich nichts; mehr auswählen "
        "oder „Rest festhalten“ ausschalten"
    ),
    "{n} face flipped by Move or Blend": "{n} Fläche durch „Verschieben“ oder „Überblendung“ umgedreht",
    "{n} faces flipped by Move or Blend": "{n} Flächen durch „Verschieben“ oder „Überblendung“ umgedreht",
    "The part solved in place now covers {n} face of the rest; select more, or move the UVs that it shares": (
        "Der vor Ort gelöste Teil verdeckt jetzt {n} Fläche des Restes; mehr auswählen oder die "
        "gemeinsamen UVs verschieben"
    ),
    "The part solved in place now covers {n} faces of the rest; select more, or move the UVs that it shares": (
        "Der vor Ort gelöste Teil verdeckt jetzt {n} Flächen des Restes; mehr auswählen oder die "
        "gemeinsamen UVs verschieben"
    ),
    "Live Spectral Unwrap": "Spektral in Echtzeit",
    "Let islands follow pins, Push/Pull and moved vertices, and unwrap again when seams or shapes change": (
        "Inseln folgen Pins, Drücken/Ziehen und bewegten Punkten; ändern sich Nähte oder Formen, wird neu abgewickelt"
    ),
    "Push pairs of selected vertices apart in the map, or pull them together": (
        "Paare ausgewählter Punkte in der UV-Map auseinanderdrücken oder zusammenziehen"
    ),
    "Adjust Push/Pull": "Drücken/Ziehen anpassen",
    "Drag to push the two vertices apart or pull them together; their island follows": (
        "Durch Bewegen der Maus die beiden Punkte auseinanderdrücken oder zusammenziehen; ihre Insel folgt"
    ),
    "Spectral": "Spektral",
    "Seams": "Nähte",
    "Unwrap": "Abwickeln",
    "Then Unwrap": "Dann abwickeln",
    "Settings": "Einstellungen",
    "Advanced": "Erweitert",
    "Last Result": "Letztes Ergebnis",
    "Clear Selected": "Naht entfernen",
    "From Islands": "Aus Inseln",
    "Nothing unwrapped yet": "Noch nichts abgewickelt",
    "Select Island": "Insel auswählen",
    "Select": "Auswählen",
    "Most Distorted": "Am stärksten verzerrte",
    "Select Stretched Faces": "Gestreckte Flächen auswählen",
    "No such faces, selection unchanged": "Keine solchen Flächen, Auswahl unverändert",
    "Seam Hint": "Nahtwunsch",
    "Tell Suggest Seams to cut the selected edges, or never to cut them": (
        "Festlegen, ob „Nähte vorschlagen“ die ausgewählten Kanten schneidet oder nie schneidet"
    ),
    "Hint": "Wunsch",
    "What Suggest Seams does with the selected edges": "Was „Nähte vorschlagen“ mit den ausgewählten Kanten macht",
    "Cut Here": "Hier Naht",
    "Suggest Seams cuts the selected edges": "„Nähte vorschlagen“ schneidet die ausgewählten Kanten",
    "Never Here": "Hier nie",
    "Suggest Seams does not cut the selected edges": "„Nähte vorschlagen“ schneidet die ausgewählten Kanten nicht",
    "Clear Hints": "Wünsche löschen",
    "Leave the selected edges to Suggest Seams": "Die ausgewählten Kanten „Nähte vorschlagen“ überlassen",
    "No edges selected": "Keine Kanten ausgewählt",
    "{wish}: {edges}": "{wish}: {edges}",
    "{n} edge": "{n} Kante",
    "{n} edges": "{n} Kanten",
    "{n} edge is cut despite Never Here: otherwise an island could not be unwrapped, or would overlap itself": (
        "{n} Kante wird trotz „Hier nie“ geschnitten: sonst ließe sich eine Insel nicht abwickeln oder überlappte sich"
    ),
    "{n} edges are cut despite Never Here: otherwise an island could not be unwrapped, or would overlap itself": (
        "{n} Kanten werden trotz „Hier nie“ geschnitten: sonst ließe sich eine Insel nicht abwickeln oder überlappte "
        "sich"
    ),
    "How seams are found": "Wie Nähte gefunden werden",
    "By Distortion": "Verzerrung",
    "Cut where that lowers distortion most": "Dort schneiden, wo es die Verzerrung am meisten senkt",
    "By Angle": "Winkel",
    "Cut the edges where faces meet at a sharp angle": "Die Kanten schneiden, an denen Flächen scharf abknicken",
    "Sharp Angle": "Scharfer Winkel",
    "Edges become seams where the surface bends by at least this angle": (
        "Kanten, an denen die Oberfläche mindestens um diesen Winkel abknickt, werden Nähte"
    ),
    "No seams to suggest: no edge is that sharp": "Keine Nähte vorzuschlagen: keine Kante ist so scharf",
    "{edges} of {degrees}° or more, length {length}": "{edges} ab {degrees}°, Länge {length}",
    "Searching ...": "Suche läuft ...",
    "Inspect Map": "UV-Map prüfen",
    "Show the numbers of the face under the mouse; click to select its island": (
        "Die Werte der Fläche unter der Maus anzeigen; ein Klick wählt ihre Insel aus"
    ),
    "Click: Select island   Shift click: Add it   Esc or right click: End": (
        "Klick: Insel auswählen   Umschalt+Klick: Hinzufügen   Esc oder Rechtsklick: Beenden"
    ),
    "Pick": "Messen",
    "Apply": "Anwenden",
    "Equalize": "Angleichen",
    "Pick Texel Density": "Texeldichte messen",
    "Show how many pixels of the texture the selected islands have per unit of length, and use that for Set Texel "
    "Density": (
        "Zeigen, wie viele Pixel der Textur die ausgewählten Inseln je Längeneinheit haben, und das für „Texeldichte "
        "setzen“ übernehmen"
    ),
    "Set Texel Density": "Texeldichte setzen",
    "Scale the selected islands to a number of pixels per unit of length": (
        "Die ausgewählten Inseln auf eine Anzahl Pixel je Längeneinheit skalieren"
    ),
    "Scale every selected island about its center to a texel density": (
        "Jede ausgewählte Insel um ihre Mitte auf eine Texeldichte skalieren"
    ),
    "To": "Auf",
    "What the islands are scaled to": "Worauf die Inseln skaliert werden",
    "Number": "Zahl",
    "Scale the selected islands of all meshes to an equal texel density, times their factors; the scale of the "
    "objects and the sizes of their textures count": (
        "Die ausgewählten Inseln aller Meshes auf die gleiche Texeldichte mal ihre Faktoren skalieren; die Skalierung "
        "der Objekte und die Größen ihrer Texturen zählen mit"
    ),
    "Give the selected islands more or fewer pixels than others, such as 1.5 for a head; kept with the mesh, for "
    "Spectral Unwrap and Equalize": (
        "Den ausgewählten Inseln mehr oder weniger Pixel geben als anderen, etwa 1,5 für einen Kopf; bleibt beim Mesh, "
        "für „Spektral abwickeln“ und „Angleichen“"
    ),
    "Density": "Dichte",
    "Pixels of the texture per unit of length, as the scene displays lengths": (
        "Pixel der Textur je Längeneinheit, wie die Szene Längen anzeigt"
    ),
    "Factor": "Faktor",
    "Texel density over that of other islands; 1 for the same": (
        "Das Wievielfache der Texeldichte anderer Inseln; 1 für die gleiche"
    ),
    "Texture Size": "Texturgröße",
    "Pixels along one side of this material's texture, for the texel density; 0 takes the size of its image": (
        "Pixel entlang einer Seite der Textur dieses Materials, für die Texeldichte; 0 nimmt die Größe seines Bildes"
    ),
    "The selected islands have no size; unwrap them first": (
        "Die ausgewählten Inseln haben keine Größe; zuerst abwickeln"
    ),
    "Store as Attribute": "Als Attribut speichern",
    "Store the distortion of every face as a mesh attribute, for rendering, geometry nodes and scripts": (
        "Die Verzerrung jeder Fläche als Attribut des Meshs speichern, für Rendering, Geometry Nodes und Skripte"
    ),
    "Push/Pull": "Drücken/Ziehen",
    "Vertex lost": "Punkt fehlt",
    # Settings of Spectral Unwrap.
    "Method": "Methode",
    "Unwrapping method": "Methode zum Abwickeln",
    "Weights": "Gewichtungen",
    "How much each triangle counts: by its area, which may shrink finely divided parts of the map, or all alike": (
        "Wie viel jedes Dreieck zählt: nach seinem Flächeninhalt, was fein unterteilte Teile der UV-Map schrumpfen "
        "lassen kann, oder alle gleich"
    ),
    "Boundary": "Begrenzung",
    "What pulls the map open: the length of its border, or the number of its vertices, which widens the map where the "
    "border is finely divided": (
        "Was die UV-Map aufspannt: die Länge ihrer Grenze, oder die Zahl ihrer Punkte, was sie weitet, wo die Grenze "
        "fein unterteilt ist"
    ),
    "Turn to Pack": "Zum Packen drehen",
    "Turn islands to fit best, which wastes less of the texture; otherwise they stand upright": (
        "Inseln drehen, wie sie am besten passen, was weniger Textur verschenkt; sonst stehen sie aufrecht"
    ),
    "Fill Holes": "Löcher füllen",
    "Virtually fill holes in mesh before unwrapping, to better avoid overlaps and preserve symmetry": (
        "Löcher im Mesh vor dem Abwickeln virtuell füllen, um Überlappungen besser zu vermeiden und Symmetrie zu "
        "erhalten"
    ),
    "Hole Rigidity": "Steifheit der Löcher",
    "Keep holes of the map open instead of letting them shrink; 1 treats them like the outer border": (
        "Löcher der UV-Map offen halten, statt sie schrumpfen zu lassen; 1 behandelt sie wie die äußere Grenze"
    ),
    "Automatic Holes": "Automatische Löcher",
    "Keep the holes of an island from shrinking where that lowers its distortion; Hole Rigidity above 0 "
    "overrides this": (
        "Die Löcher einer Insel am Schrumpfen hindern, wo das ihre Verzerrung senkt; eine „Steifheit der Löcher“ "
        "über 0 hat Vorrang"
    ),
    "Angle to Area": "Winkel zu Fläche",
    "0 keeps angles, and sizes vary; 1 keeps sizes even, at the cost of angles": (
        "0 erhält Winkel, und Größen schwanken; 1 erhält gleichmäßige Größen auf Kosten der Winkel"
    ),
    "0 evens out angles only; 1 evens out angles and sizes": (
        "0 gleicht nur Winkel aus, 1 gleicht Winkel und Größen aus"
    ),
    "Steps": "Schritte",
    "Maximum number of steps; it stops earlier if no step helps": (
        "Höchstzahl der Schritte; es endet früher, wenn kein weiterer hilft"
    ),
    "Border": "Inselrand",
    "What the borders of islands do": "Was die Ränder der Inseln tun",
    "Borders move, too": "Die Ränder bewegen sich mit",
    "Sliding": "Gleitend",
    "Vertices on straight borders move along them, so outlines stay; corners and curved borders are held": (
        "Punkte auf geraden Rändern bewegen sich an ihnen entlang, sodass Umrisse bleiben; Ecken und gekrümmte Ränder "
        "werden festgehalten"
    ),
    "Held": "Fest",
    "Borders stay where they are; only the inside moves": (
        "Die Ränder bleiben, wo sie sind; nur das Innere bewegt sich"
    ),
    "First remove flipped faces and overlaps, as Unwrap does. Islands that are selected as a whole and have no pins "
    "are unwrapped anew if necessary": (
        "Zuerst umgedrehte Flächen und Überlappungen entfernen, wie beim Abwickeln. Inseln, die ganz ausgewählt "
        "sind und keine Pins haben, werden dafür nötigenfalls neu abgewickelt"
    ),
    "No Flip": "Kein Umdrehen",
    "Unfold flipped faces and islands that overlap themselves, at some cost in angles; difficult islands take longer": (
        "Umgedrehte Flächen und Inseln, die sich selbst überlappen, auf Kosten der Winkel entfalten; bei "
        "schwierigen Inseln dauert das länger"
    ),
    "Straighten Borders": "Ränder begradigen",
    "Make borders that are nearly straight exactly so, and nearly rectangular islands rectangles, where that hardly "
    "changes the map; no effect on islands with pins or stored shapes": (
        "Fast gerade Ränder ganz gerade machen und fast rechteckige Inseln zu Rechtecken, wo das die UV-Map kaum "
        "ändert; ohne Wirkung auf Inseln mit Pins oder gespeicherten Formen"
    ),
    "Polish": "Nachbessern",
    "Improve the finished map in a few steps": "Die fertige UV-Map in wenigen Schritten verbessern",
    "Leave the map as the solver found it": "Die UV-Map lassen, wie der Löser sie gefunden hat",
    "Lower the angle distortion as far as it goes": "Die Winkelverzerrung senken, so weit es geht",
    "Angles": "Winkel",
    "Off": "Aus",
    "Balanced": "Ausgewogen",
    "Lower the angle distortion, and spend half of the gain on even sizes": (
        "Die Winkelverzerrung senken und die Hälfte des Gewinns für gleichmäßige Größen ausgeben"
    ),
    "Edge Stretch": "Kantenstreckung",
    "How much longer the map becomes along the active edge than across it": (
        "Wie viel länger die UV-Map längs der aktiven Kante wird als quer dazu"
    ),
    "Show rarely used settings": "Selten benutzte Einstellungen anzeigen",
    "Use Subdivision Surface": "Unterteilungsoberfläche verwenden",
    "Map UVs taking vertex position after Subdivision Surface modifier has been applied": (
        "UVs nach den Punktpositionen erzeugen, die der Modifikator „Oberflächenunterteilung“ ergibt"
    ),
    "Soft Pins": "Weiche Pins",
    "Let pinned UVs attract the map, which gives way, instead of holding it; Spectral method only": (
        "Gepinnte UVs die UV-Map anziehen lassen, die nachgibt, statt sie festzuhalten; nur für die spektrale Methode"
    ),
    "Strength": "Stärke",
    "How strongly soft pins attract; 1000 comes close to hard pins": (
        "Wie stark weiche Pins anziehen; 1000 kommt festen Pins nahe"
    ),
    "Correct Aspect": "Seitenverhältnis korrigieren",
    "Map UVs taking image aspect ratio into account": (
        "UVs unter Berücksichtigung des Seitenverhältnisses des Bildes erzeugen"
    ),
    "Margin": "Rand",
    # Settings of Suggest Seams.
    "Size Variation": "Größenschwankung",
    "Size differences allowed on 95 % of the surface, as a factor; higher needs fewer seams": (
        "Erlaubte Größenunterschiede auf 95 % der Oberfläche, als Faktor; ein höherer braucht weniger Nähte"
    ),
    "Angle Distortion": "Winkelverzerrung",
    "Stretching allowed; higher needs fewer seams. 0 keeps all angles, 10 lets them be off by 10 % on average": (
        "Erlaubte Streckung; eine höhere braucht weniger Nähte. 0 erhält alle Winkel, bei 10 weichen sie im Mittel um "
        "10 % ab"
    ),
    "Keep Front Clear": "Front freihalten",
    "How far seams keep away from faces toward the front (the object's -Y); 0 treats all sides alike": (
        "Wie weit Nähte Flächen ausweichen, die nach vorn zeigen (-Y des Objekts); bei 0 sind alle Seiten gleich"
    ),
    "Vertex Group": "Punktgruppe",
    "Vertex group whose painted weights attract seams or keep them away": (
        "Punktgruppe, deren gemalte Gewichte Nähte anziehen oder fernhalten"
    ),
    "Group Effect": "Bedeutung der Gruppe",
    "Whether the weights attract seams or keep them away": "Ob die Gewichte Nähte anziehen oder fernhalten",
    "No Seams Here": "Hier keine Nähte",
    "Seams avoid high weights": ("Nähte machen um hohe Gewichte einen Umweg"),
    "Seams Here": "Hier Nähte",
    "Seams prefer high weights": "Nähte verlaufen lieber bei hohen Gewichten",
    "Maximum Length": "Höchstlänge",
    "Limit on the total length of new seams of a mesh, ignoring the object's scale; 0 for no limit. Cuts that "
    "open closed islands and handles are always made": (
        "Grenze für die Gesamtlänge neuer Nähte eines Meshs, ohne die Skalierung des Objekts; 0 für keine. "
        "Schnitte, die geschlossene Inseln und Henkel öffnen, werden immer gemacht"
    ),
    "Cuts": "Schnitte",
    "Number of suggested cuts to mark, most useful first; 0 for all": (
        "Wie viele der vorgeschlagenen Schnitte markiert werden, die nützlichsten zuerst; 0 für alle"
    ),
    "Afterward, unwrap the faces with the last settings of Spectral Unwrap": (
        "Die Flächen danach mit den letzten Einstellungen von „Spektral abwickeln“ abwickeln"
    ),
    # Settings of the operators that select and store.
    "Flipped": "Umgedreht",
    "Faces that are flipped relative to the rest of their island": (
        "Flächen, die gegenüber dem Rest ihrer Insel umgedreht sind"
    ),
    "Overlapping": "Überlappend",
    "Faces that overlap another face of their island": "Flächen, die eine andere Fläche ihrer Insel überlappen",
    "Between Islands": "Zwischen Inseln",
    "Also select faces that overlap another island, of any mesh in edit mode": (
        "Auch Flächen auswählen, die eine andere Insel überlappen, bei allen Meshes im Bearbeitungsmodus"
    ),
    "Extend": "Erweitern",
    "Add to the selection instead of replacing it": "Zur Auswahl hinzufügen, statt sie zu ersetzen",
    "Islands": "Inseln",
    "Islands of the last result, worst first": "Die Inseln des letzten Ergebnisses, die schlechtesten zuerst",
    "Island": "Insel",
    "Click an island to select its faces": "Eine Insel anklicken, um ihre Flächen auszuwählen",
    "By": "Nach",
    "How faces are ranked": "Wonach Flächen geordnet werden",
    "Faces whose angles are off the most": ("Flächen, deren Winkel am weitesten abweichen"),
    "Size": "Größe",
    "Faces whose size in the map differs most from the median": (
        "Flächen, deren Größe in der UV-Map am weitesten vom Median abweicht"
    ),
    "Amount": "Menge",
    "Share of the surface to select, worst faces first": (
        "Anteil der Oberfläche, der ausgewählt wird, die schlechtesten Flächen zuerst"
    ),
    "Beyond Limit": "Jenseits der Grenze",
    "Select everything beyond a limit instead of a share of the surface": (
        "Alles jenseits einer Grenze auswählen statt eines Anteils der Oberfläche"
    ),
    "Limit": "Grenze",
    "How far angles may be off": "Wie weit Winkel abweichen dürfen",
    "Factor by which sizes may differ from the median": "Faktor, um den Größen vom Median abweichen dürfen",
    "Whole Islands": "Ganze Inseln",
    "Rank islands by their average instead of faces": "Inseln nach ihrem Durchschnitt ordnen statt Flächen",
    "Store": "Speichern",
    "What to store": "Was gespeichert wird",
    "As Colors": "Als Farben",
    "Store the colors of the overlay at face corners instead of one number per face": (
        "Die Farben des Overlays an den Ecken der Flächen speichern statt einer Zahl je Fläche"
    ),
    # The overlay that shows the map, and its colors.
    "UV Map Overlay": "UV-Map-Overlay",
    "Show UV Map": "UV-Map anzeigen",
    "Color the faces by the quality of the active UV map, in the 3D viewport and the UV editor": (
        "Die Flächen im 3D-Ansichtsfenster und im UV-Editor nach der Güte der aktiven UV-Map färben"
    ),
    "Show": "Anzeigen",
    "What the colors show": "Was die Farben zeigen",
    "Custom Range": "Eigener Bereich",
    "Set the values at both ends of the colors; otherwise they are the same on all maps: angles off by 0 to 50 %, "
    "sizes of half to double the median": (
        "Die Werte an beiden Enden der Farbskala festlegen; sonst sind sie für alle UV-Maps gleich: Winkel weichen um "
        "0 bis 50 % ab, Größen reichen von der Hälfte bis zum Doppelten des Medians"
    ),
    "Auto": "Auto",
    "Fit Colors to Map": "Farben an UV-Map anpassen",
    "Fit the custom range to most of the surface; it stays the same while the map changes": (
        "Den benutzerdefinierten Bereich an den größten Teil der Oberfläche anpassen; er bleibt, wenn sich die UV-Map "
        "ändert"
    ),
    "{name}: {mean}, {density}": "{name}: {mean}, {density}",
    "{name}: nothing to measure": "{name}: nichts zu messen",
    "and {n} more": "und {n} weitere",
    "Stacks and Margin": "Stapel und Rand",
    "Stacks of equal or mirrored islands in one color each, and the margin around islands as a band": (
        "Stapel gleicher oder gespiegelter Inseln in je einer Farbe, und der Rand um Inseln als Band"
    ),
    "Margin of {margin} px: too narrow where bands touch": "Rand von {margin} px: zu schmal, wo Bänder sich berühren",
    "No stacks": "Keine Stapel",
    "{n} stack of {islands}": "{n} Stapel aus {islands}",
    "{n} stacks of {islands}": "{n} Stapel aus {islands}",
    "Low": "Niedrig",
    "Value at the lower end of the colors; for angles the percentage they are off, for sizes a factor, 1 for the "
    "median": (
        "Wert am unteren Ende der Farbskala; bei Winkeln, um wie viel Prozent sie abweichen, bei Größen ein Faktor, 1 "
        "für den Median"
    ),
    "High": "Hoch",
    "Value at the upper end of the colors; for angles the percentage they are off, for sizes a factor, 1 for the "
    "median": (
        "Wert am oberen Ende der Farbskala; bei Winkeln, um wie viel Prozent sie abweichen, bei Größen ein Faktor, 1 "
        "für den Median"
    ),
    "Opacity": "Deckkraft",
    "Opacity of the colors": "Deckkraft der Farben",
    "Squares": "Quadrate",
    "Checker squares along one side of a UV tile": ("Quadrate des Schachbretts entlang einer Seite einer UV-Kachel"),
    "Legend": "Legende",
    "Show what the colors mean, and the numbers of the map": (
        "Die Bedeutung der Farben und die Werte der UV-Map anzeigen"
    ),
    "Spectral Unwrap Defaults": "Voreinstellungen für „Spektral abwickeln“",
    "Limits": "Grenzen",
    "Solver": "Gleichungslöser",
    "{name}, OpenBLAS kernels for {kernel}": "{name}, OpenBLAS mit den Kernen für {kernel}",
    "Threads": "Threads",
    "Processor cores to use; 0 for all. The map does not depend on it": (
        "Zu nutzende Prozessorkerne; 0 für alle. Die UV-Map hängt nicht davon ab"
    ),
    "Overlay: Faces": "Overlay: Flächen",
    "Meshes with more faces are not colored, because the overlay follows every edit": (
        "Meshes mit mehr Flächen werden nicht gefärbt, da das Overlay jeder Bearbeitung folgt"
    ),
    "Live Unwrap: Faces": "Echtzeit: Flächen",
    "Live Spectral Unwrap skips meshes with more faces, because it cannot be canceled": (
        "„Spektral in Echtzeit“ lässt Meshes mit mehr Flächen aus, denn es lässt sich nicht abbrechen"
    ),
    "Too many faces to color:": "Zu viele Flächen zum Färben:",
    "The add-on's preferences set the limit": "Grenze: Einstellungen des Add-ons",
    "Too many faces to follow": "Zu viele Flächen für Echtzeit",
    "Colors of the UV Map Overlay": "Farben des UV-Map-Overlays",
    "Angles Kept": "Winkel erhalten",
    "Color of faces whose angles are kept": "Farbe von Flächen, deren Winkel erhalten bleiben",
    "Between": "Dazwischen",
    "Color of the middle of the range": "Farbe der Mitte des Bereichs",
    "Angles Distorted": "Winkel verzerrt",
    "Color of the end of the range and beyond": "Farbe vom Ende des Bereichs an",
    "Small": "Klein",
    "Color of faces smaller in the map than most": (
        "Farbe von Flächen, die in der UV-Map kleiner sind als die meisten"
    ),
    "Even": "Gleichmäßig",
    "Color of faces of median size": "Farbe von Flächen mittlerer Größe",
    "Large": "Groß",
    "Color of faces larger in the map than most": ("Farbe von Flächen, die in der UV-Map größer sind als die meisten"),
    # Extenders.
    "Above 0 pushes apart, below 0 pulls together; 1 is moderate": (
        "Über 0 drückt auseinander, unter 0 zieht zusammen; 1 ist mäßig"
    ),
    "Name": "Name",
    "Name in the list": "Name in der Liste",
    "Use": "Verwenden",
    "Use it in the next unwrap": "Beim nächsten Abwickeln einhalten",
    "Layer": "Ebene",
    "Attribute of the vertices or edges that marks them": "Attribut der Punkte oder Kanten, das sie markiert",
    "Active Shape": "Aktive Form",
    "The one chosen in the panel": "Die im Panel gewählte",
    # What enumerations offer.
    "Least angle distortion, with a free boundary and without pins": (
        "Geringste Winkelverzerrung, mit freier Begrenzung und ohne Pins"
    ),
    "Least Squares": "Kleinste Quadrate",
    "Least squares conformal map, pinned at the two boundary vertices farthest apart": (
        "Konforme Abbildung kleinster Quadrate, an den beiden am weitesten voneinander entfernten Punkten der "
        "Begrenzung gepinnt"
    ),
    "Uniform": "Einheitlich",
    "Every triangle counts by its area": "Jedes Dreieck zählt nach seinem Flächeninhalt",
    "Inverse Area": "Inverser Flächeninhalt",
    "Every triangle counts the same; for unevenly divided meshes": (
        "Jedes Dreieck zählt gleich viel; für ungleichmäßig unterteilte Meshes"
    ),
    "Length": "Länge",
    "Weight boundary vertices by the length of their boundary edges": (
        "Punkte der Begrenzung nach der Länge ihrer Begrenzungskanten gewichten"
    ),
    "Vertex": "Punkt",
    "Weight all boundary vertices equally, as in the original paper": (
        "Alle Punkte der Begrenzung gleich gewichten, wie in der ursprünglichen Veröffentlichung"
    ),
    "How far angles are off; 0 % where they are kept": ("Wie weit Winkel abweichen; 0 %, wo sie erhalten bleiben"),
    "Size in the map relative to the surface in the world, compared with the median": (
        "Größe in der UV-Map im Verhältnis zur Oberfläche in der Welt, verglichen mit dem Median"
    ),
    "Texel Density": "Texeldichte",
    "Pixels of the texture per unit of length in the world": "Pixel der Textur je Längeneinheit in der Welt",
    "Flipped and Overlapping": "Umgedreht, überlappend",
    "Faces that are flipped or overlap others of their island": (
        "Flächen, die umgedreht sind oder andere ihrer Insel überlappen"
    ),
    "Checker": "Schachbrett",
    "Checker squares on the surface; materials stay as they are": (
        "Schachbrett auf der Oberfläche; Materialien bleiben, wie sie sind"
    ),
    "Pack": "Packen",
    "Keep in Place": "Vor Ort lassen",
    "Keep every island in its former bounding box and orientation, instead of packing all": (
        "Jede Insel in ihrem früheren Begrenzungsrahmen und ihrer Ausrichtung lassen, statt alle zu packen"
    ),
    # What is said of a selection, and why something cannot be done.
    "Select two vertices; or several, ending with the one to connect the others to": (
        "Zwei Punkte auswählen, oder mehrere und zuletzt den, der mit den anderen verbunden werden soll"
    ),
    "No vertex is active; Shift-click the one to connect the others to": (
        "Kein Punkt ist aktiv; den Punkt mit Umschalt+Klick auswählen, mit dem die anderen verbunden werden sollen"
    ),
    "No effect: the vertices lie in different islands; remove the seams between them": (
        "Ohne Wirkung: die Punkte liegen in verschiedenen Inseln; die Nähte dazwischen entfernen"
    ),
    "No effect: pins hold both ends; unpin one or use soft pins": (
        "Ohne Wirkung: Pins halten beide Enden fest; eines lösen oder weiche Pins verwenden"
    ),
    "Subdivision Surface modifier needs to be first to work with unwrap": (
        "Der Modifikator „Oberflächenunterteilung“ muss an erster Stelle stehen, um beim Abwickeln zu wirken"
    ),
    "Nothing was stretched: no edge is active; click the edge to stretch along": (
        "Nichts wurde gestreckt: keine Kante ist aktiv; die Kante anklicken, entlang der gestreckt werden soll"
    ),
    "Adjusting ignores the Subdivision Surface modifier; unwrap again to include it": (
        "Anpassen berücksichtigt den Modifikator „Oberflächenunterteilung“ nicht; dafür neu abwickeln"
    ),
    "Push/Pull works with the Spectral method only; unwrap with it": (
        "Drücken/Ziehen wirkt nur bei der Methode „Spektral“; mit dieser abwickeln"
    ),
    "No vertices selected; select the vertices to connect, one after the other": (
        "Keine Punkte ausgewählt; die zu verbindenden Punkte nacheinander auswählen"
    ),
    "The amount must be a number, not nan": "Der Betrag muss eine Zahl sein, nicht nan",
    "Not enough memory to update the map; close other programs, or add seams": (
        "Zu wenig Speicher, um die UV-Map zu aktualisieren; andere Programme schließen oder Nähte hinzufügen"
    ),
    "Not enough memory for this mesh; close other programs, select fewer faces, or add seams": (
        "Zu wenig Speicher für dieses Mesh; andere Programme schließen, weniger Flächen auswählen oder Nähte hinzufügen"
    ),
    "Choose a Push/Pull in the list first": "Zuerst ein Drücken/Ziehen in der Liste wählen",
    "The list has no such entry; choose another": "Die Liste hat keinen solchen Eintrag; einen anderen wählen",
    "Enter or click: Confirm   Esc or right click: Cancel   Shift: Precision": (
        "Eingabe oder Klick: Bestätigen   Esc oder Rechtsklick: Abbrechen   Umschalt: Genau"
    ),
    "No faces selected": "Keine Flächen ausgewählt",
    "The meshes changed during the solve, so nothing was written; unwrap again": (
        "Die Meshes haben sich während der Berechnung geändert, darum wurde nichts geschrieben; neu abwickeln"
    ),
    "Nothing was selected, so all visible faces were relaxed": (
        "Nichts war ausgewählt, darum wurden alle sichtbaren Flächen entspannt"
    ),
    "Nothing can move: all UVs of these faces are pinned, held or bound by a stored shape": (
        "Nichts kann sich bewegen: Alle UVs dieser Flächen sind gepinnt, festgehalten oder durch eine "
        "gespeicherte Form gebunden"
    ),
    "UVs that violate a stored shape stayed; unwrap again, or clear its check mark in the list": (
        "UVs, die eine gespeicherte Form verletzen, blieben; neu abwickeln oder ihr Häkchen in der Liste entfernen"
    ),
    "{n} island was not turned: it is bound by a stored shape": (
        "{n} Insel wurde nicht gedreht: Sie ist durch eine gespeicherte Form gebunden"
    ),
    "{n} islands were not turned: they are bound by a stored shape": (
        "{n} Inseln wurden nicht gedreht: Sie sind durch gespeicherte Formen gebunden"
    ),
    "Nothing was selected, so all visible faces were used": (
        "Nichts war ausgewählt, darum wurden alle sichtbaren Flächen verwendet"
    ),
    "No visible faces to cut": "Keine sichtbaren Flächen zum Aufschneiden",
    "Something else has changed the map meanwhile, which stays as it is now": (
        "Etwas anderes hat die Map inzwischen geändert; sie bleibt, wie sie jetzt ist"
    ),
    "The meshes changed meanwhile, so nothing was marked; suggest seams again": (
        "Die Meshes haben sich inzwischen geändert, darum wurde nichts markiert; Nähte neu vorschlagen lassen"
    ),
    "Not enough memory, so nothing was changed; close other programs, select fewer faces, or lower the subdivision "
    "levels": (
        "Zu wenig Speicher, darum wurde nichts geändert; andere Programme schließen, weniger Flächen auswählen oder "
        "die Unterteilungsstufen senken"
    ),
    "{percent} of the tile filled": "Kachel zu {percent} gefüllt",
    "{percent} of {n} tiles filled": "{n} Kacheln zu {percent} gefüllt",
    "{percent} of the box filled": "Rechteck zu {percent} gefüllt",
    "Islands that stay leave too little room in the UV tile, so the others were packed beside it": (
        "Inseln, die bleiben, lassen zu wenig Platz in der UV-Kachel, darum wurden die anderen daneben gepackt"
    ),
    "These meshes have not been unwrapped since the file was opened; unwrap first": (
        "Diese Meshes wurden seit dem Öffnen der Datei nicht abgewickelt; zuerst abwickeln"
    ),
    "There is no UV map; unwrap first": "Es gibt keine UV-Map; zuerst abwickeln",
    # How islands with pins were solved: goes into the sentence on them.
    "pinned least squares (LSCM)": "der Methode der kleinsten Quadrate mit festen Pins (LSCM)",
    "the spectral method with soft pins": "der spektralen Methode mit weichen Pins",
    # Numbers with what they count, and sentences with numbers.
    "{n} cut": "{n} Schnitt",
    "{n} cuts": "{n} Schnitte",
    "{n} push/pull": "{n} Drücken/Ziehen",
    "{n} pushes/pulls": "{n} Drücken/Ziehen",
    "{n} face": "{n} Fläche",
    "{n} faces": "{n} Flächen",
    "{n} step": "{n} Schritt",
    "{n} steps": "{n} Schritten",
    "Relaxed in {steps}: distortion hardly lower": "In {steps} entspannt: Verzerrung kaum geringer",
    "Relaxed in {steps}: distortion {percent} lower": "In {steps} entspannt: Verzerrung um {percent} geringer",
    "{operator}: {steps}, distortion {percent} lower   {keys}": (
        "{operator}: nach {steps} Verzerrung um {percent} geringer   {keys}"
    ),
    "{n} group": "{n} Gruppe",
    "{n} groups": "{n} Gruppen",
    "{n} island": "{n} Insel",
    "{n} islands": "{n} Inseln",
    "{operator} is running; Esc cancels it": "„{operator}“ läuft; Esc bricht ab",
    "{operator}: Canceled": "{operator}: Abgebrochen",
    "{operator}: {percent} %   Esc: Cancel": "{operator}: {percent} %   Esc: Abbrechen",
    "{operator}: {phase}, {percent} %   Esc: Cancel": "{operator}: {phase}, {percent} %   Esc: Abbrechen",
    "Finding islands": "Inseln suchen",
    "Finding seams": "Nähte suchen",
    "Measuring the surface": "Oberfläche messen",
    "Flattening islands": "Inseln verebnen",
    "Polishing": "Glätten",
    "Removing flips": "Umgedrehte entfalten",
    "Relaxing": "Entspannen",
    "Placing islands": "Inseln anordnen",
    "Packing": "Packen",
    "Measuring the map": "UV-Map messen",
    "Done": "Fertig",
    "{operator}: {percent} % ({phase})": "{operator}: {percent} % ({phase})",
    "{operator} could not follow: {problem}": "„{operator}“ konnte nicht folgen: {problem}",
    "{name} could not be drawn: {problem}": "„{name}“ konnte nicht gezeichnet werden: {problem}",
    "Unwrapped {islands}: angles off beyond measure, because faces shrink to nothing": (
        "{islands} abgewickelt: Winkelabweichung nicht messbar, da Flächen verschwinden"
    ),
    "{operator} finds where to cut": "„{operator}“ findet, wo zu schneiden ist",
    "Unwrapped {islands}: angles off by {mean} on average, {worst} at worst": (
        "{islands} abgewickelt: Winkel weichen im Mittel um {mean} ab, höchstens um {worst}"
    ),
    "{seconds} s": "{seconds} s",
    "no flipped faces": "keine umgedrehten Flächen",
    "{n} flipped face": "{n} umgedrehte Fläche",
    "{n} flipped faces": "{n} umgedrehte Flächen",
    "{n} overlapping face": "{n} überlappende Fläche",
    "{n} overlapping faces": "{n} überlappende Flächen",
    "{n} face overlaps another island now; {operator} separates them": (
        "{n} Fläche überlappt jetzt eine andere Insel; „{operator}“ trennt sie"
    ),
    "{n} faces overlap other islands now; {operator} separates them": (
        "{n} Flächen überlappen jetzt andere Inseln; „{operator}“ trennt sie"
    ),
    "{faces} (see {operator})": "{faces} (siehe „{operator}“)",
    # The legend and the list of islands.
    "{factor} x": "{factor} x",
    "good": "gut",
    "overlapping": "überlappend",
    "flipped": "umgedreht",
    "{name}: {faces}, nothing to measure": "{name}: {faces}, nichts zu messen",
    "Angles off {mean}, worst {worst}": "Winkelfehler {mean}, höchstens {worst}",
    "{name}: {faces}": "{name}: {faces}",
    "Sizes vary by {percent} %": "Größen schwanken um {percent} %",
    "{flipped} flipped, {overlapping} overlapping": "{flipped} umgedreht, {overlapping} überlappend",
    "{n} f.": "{n} Fl.",
    "{n} flipped": "{n} umgedreht",
    "{n} overlap": "{n} überlappen",
    "Not unwrapped   {n} f.": "Nicht abgewickelt   {n} Fl.",
    "The faces of this island have changed; unwrap again": (
        "Die Flächen dieser Insel haben sich geändert; neu abwickeln"
    ),
    "Selected {faces}": "{faces} ausgewählt",
    "{name}: angles off by {qc}": "{name}: Winkel weichen um {qc} ab",
    "Size {size}, {density}": "Größe {size}, {density}",
    "{density} px/{unit}": "{density} px/{unit}",
    "{name} (px/{unit})": "{name} (px/{unit})",
    "unit": "Einheit",
    "{islands}: {density}": "{islands}: {density}",
    "{islands}: {density} together, from {low} to {high}": "{islands}: zusammen {density}, von {low} bis {high}",
    "Scaled {islands} to {density}; pack them if they overlap now": (
        "{islands} auf {density} skaliert; bei Überlappungen neu packen"
    ),
    "{n} island has a factor of its own": "{n} Insel hat einen eigenen Faktor",
    "{n} islands have factors of their own": "{n} Inseln haben eigene Faktoren",
    "{islands}: factor {factor}; {unwrap} and {equalize} use it": (
        "{islands}: Faktor {factor}; „{unwrap}“ und „{equalize}“ verwenden ihn"
    ),
    "{objects}: scaled unevenly, so every island has an average texel density; apply the scale": (
        "{objects}: ungleichmäßig skaliert, darum hat jede Insel eine mittlere Texeldichte; die Skalierung anwenden"
    ),
    "Flipped and overlapping": "Umgedreht und überlappend",
    "Stored as {name}": "Als {name} gespeichert",
    "{percent} %": "{percent} %",
    "Shown": "Angezeigt",
    "Active island": "Aktive Insel",
    "Under the mouse": "Unter der Maus",
    # What is said of an unwrap.
    "{n} flipped triangle unfolded": "{n} umgedrehtes Dreieck entfaltet",
    "{n} flipped triangles unfolded": "{n} umgedrehte Dreiecke entfaltet",
    "{n} island needed the slower method": "{n} Insel brauchte die langsamere Methode",
    "{n} islands needed the slower method": ("{n} Inseln brauchten die langsamere Methode"),
    "No Flip: {changes}": "Kein Umdrehen: {changes}",
    "No Flip: {changes}; angles there off by {after} on average, {before} before": (
        "Kein Umdrehen: {changes}; Winkel weichen dort im Mittel um {after} ab, vorher um {before}"
    ),
    "{n} face is stretched to more than twice its width, {worst} times ({operator}); add seams there": (
        "{n} Fläche ist auf mehr als das Doppelte ihrer Breite gestreckt, auf das {worst}-Fache ({operator}); dort "
        "Nähte hinzufügen"
    ),
    "{n} faces are stretched to more than twice their width, up to {worst} times ({operator}); add seams there": (
        "{n} Flächen sind auf mehr als das Doppelte ihrer Breite gestreckt, bis auf das {worst}-Fache ({operator}); "
        "dort Nähte hinzufügen"
    ),
    "{n} island varies in size by {percent} %; add a seam that opens it, or raise Angle to Area": (
        "In {n} Insel schwanken die Größen um {percent} %; eine Naht hinzufügen, die sie öffnet, oder „Winkel zu "
        "Fläche“ erhöhen"
    ),
    "{n} islands vary in size, by up to {percent} %; add seams that open them, or raise Angle to Area": (
        "In {n} Inseln schwanken die Größen um bis zu {percent} %; Nähte hinzufügen, die sie öffnen, oder „Winkel zu "
        "Fläche“ erhöhen"
    ),
    "{n} face is too small for the precision of Blender's UVs; add seams that make its island flatter, or "
    "raise Angle to Area": (
        "{n} Fläche ist zu klein für die Genauigkeit von Blenders UVs; Nähte hinzufügen, die ihre Insel flacher "
        "machen, oder „Winkel zu Fläche“ erhöhen"
    ),
    "{n} faces are too small for the precision of Blender's UVs; add seams that make their islands flatter, "
    "or raise Angle to Area": (
        "{n} Flächen sind zu klein für die Genauigkeit von Blenders UVs; Nähte hinzufügen, die ihre Inseln "
        "flacher machen, oder „Winkel zu Fläche“ erhöhen"
    ),
    "{failed} of {islands} failed, UVs unchanged: {reasons}": (
        "{failed} von {islands} fehlgeschlagen, UVs unverändert: {reasons}"
    ),
    "{message} (and {n} similar)": "{message} (und {n} ähnliche)",
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
    "Skipped {n} push/pull that lost a vertex: {names}": (
        "{n} Drücken/Ziehen übersprungen, dem ein Punkt fehlt: {names}"
    ),
    "Skipped {n} pushes/pulls that lost a vertex: {names}": (
        "{n} Drücken/Ziehen übersprungen, denen ein Punkt fehlt: {names}"
    ),
    "{name} lost a vertex; remove it and add another": (
        "{name} fehlt ein Punkt; entfernen und einen anderen hinzufügen"
    ),
    "{operator}: {amount} %   {note}": "{operator}: {amount} %   {note}",
    "More would fold the island; add a seam, or push or pull other vertices": (
        "Weiter würde die Insel falten; eine Naht ergänzen oder andere Punkte drücken oder ziehen"
    ),
    "Half": "Hälfte",
    "Strength at 50 %, which has half of the full effect; measured when the pair is added": (
        "Stärke bei 50 %, mit der Hälfte der vollen Wirkung; gemessen, wenn das Paar hinzugefügt wird"
    ),
    "Above 0 pushes the vertices apart, below 0 pulls them together; start at 50 %, as 100 % may fold the island. "
    "In an island with pins, and in a part whose rest is held, 50 % doubles their distance and -50 % halves it": (
        "Über 0 drückt die Punkte auseinander, unter 0 zieht sie zusammen; 50 % ist ein guter Anfang, 100 % kann die "
        "Insel falten. In einer Insel mit Pins und in einem Teil, dessen Rest festgehalten ist, verdoppelt 50 % ihren "
        "Abstand, und -50 % halbiert ihn"
    ),
    "Added {extenders}": "{extenders} hinzugefügt",
    "Added {extenders} for the next unwrap; {operator} acts at once": (
        "{extenders} für das nächste Abwickeln hinzugefügt; „{operator}“ wirkt sofort"
    ),
    "Pairs that already have one: {n}": "Paare, die schon eines haben: {n}",
    "{n} push/pull had no effect: both vertices must lie in one unwrapped island, not both pinned": (
        "{n} Drücken/Ziehen hatte keine Wirkung: beide Punkte müssen in einer abgewickelten Insel liegen und "
        "nicht beide gepinnt sein"
    ),
    "{n} pushes/pulls had no effect: both vertices must lie in one unwrapped island, not both pinned": (
        "{n} Drücken/Ziehen hatten keine Wirkung: beide Punkte müssen in einer abgewickelten Insel liegen und "
        "nicht beide gepinnt sein"
    ),
    # What is said of what was selected.
    "No islands failed, selection unchanged": "Keine Insel ist fehlgeschlagen, Auswahl unverändert",
    "{n} failed island": "{n} fehlgeschlagenen Insel",
    "{n} failed islands": "{n} fehlgeschlagenen Inseln",
    "Selected {faces} of {islands}": "{faces} von {islands} ausgewählt",
    "The faces of {names} have changed since the last unwrap; unwrap again": (
        "Die Flächen von {names} haben sich seit dem letzten Abwickeln geändert; neu abwickeln"
    ),
    "No flipped or overlapping faces, selection unchanged": (
        "Keine umgedrehten oder überlappenden Flächen, Auswahl unverändert"
    ),
    "No flipped faces, selection unchanged": "Keine umgedrehten Flächen, Auswahl unverändert",
    "No overlapping faces, selection unchanged": "Keine überlappenden Flächen, Auswahl unverändert",
    "{n} overlapping": "{n} überlappend",
    "{n} with invalid UVs": "{n} mit ungültigen UVs",
    "Selected {faces}: {kinds}": "{faces} ausgewählt: {kinds}",
    # Suggested seams.
    "Marked {cuts}, length {length}": "{cuts} markiert, Länge {length}",
    "No seams to suggest: the islands are good enough, or no cut within the length limit improves them": (
        "Keine Nähte vorzuschlagen: die Inseln sind gut genug, oder kein Schnitt innerhalb der Höchstlänge "
        "verbessert sie"
    ),
    "No seams to suggest: the islands are good enough, or no cut improves them": (
        "Keine Nähte vorzuschlagen: die Inseln sind gut genug, oder kein Schnitt verbessert sie"
    ),
    "No seams suggested for {meshes}": "Keine Nähte vorgeschlagen für {meshes}",
    "{cuts}, length {length}": "{cuts}, Länge {length}",
    "{n} of {cuts}, length {length} of {total}": "{cuts}, davon gezeigt: {n}, Länge {length} von {total}",
    "Wheel, +/-, Page keys: Fewer or more   Enter or click on the mesh: Apply   Esc or right click: Cancel": (
        "Mausrad, +/-, Bild auf/ab: Anzahl   Eingabe oder Klick auf das Mesh: Anwenden   Esc oder Rechtsklick: "
        "Abbrechen"
    ),
    "{operator}: {known}   {keys}": "{operator}: {known}   {keys}",
    "{percent} of the surface within {factor} times the median scale (now {now})": (
        "{percent} der Oberfläche bis Faktor {factor} um den Median der Größe (jetzt {now})"
    ),
    "angles off by {mean} on average": "Winkel im Mittel um {mean} verzerrt",
    "angles off by {mean} on average (now {now})": "Winkel im Mittel um {mean} verzerrt (jetzt {now})",
    "beyond measure": "mehr, als sich messen lässt",
    # What the solver says: `spectral_conformal.hosts.message_templates`.
    "The first solve failed its checks and was repeated with a larger shift and another start.": (
        "Die erste Lösung bestand ihre Prüfungen nicht und wurde mit größerer Verschiebung und anderem Anfang "
        "wiederholt."
    ),
    "The boundary of the map winds around {count} times instead of once.": (
        "Der Rand der Map läuft {count}-mal herum statt einmal."
    ),
    "Hole rigidity lowered from {before} to {after}, the most that the island allows.": (
        "Steifheit der Löcher von {before} auf {after} gesenkt; mehr verträgt die Insel nicht."
    ),
    "{count} triangle of the relaxed map could not be unfolded.": (
        "{count} Dreieck der entspannten Map ließ sich nicht entfalten."
    ),
    "{count} triangles of the relaxed map could not be unfolded.": (
        "{count} Dreiecke der entspannten Map ließen sich nicht entfalten."
    ),
    "The folds left no room to unfold them: replaced by an embedding, relaxed without folding it; angles are off by "
    "{after} % on average, {before} % before.": (
        "Zum Entfalten war kein Platz: durch eine Einbettung ersetzt, die ohne Falten entspannt wurde; Winkel weichen "
        "im Mittel um {after} % ab, vorher um {before} %."
    ),
    "{count} flipped triangle unfolded; angles are off by {after} % on average, {before} % before.": (
        "{count} umgedrehtes Dreieck entfaltet; Winkel weichen im Mittel um {after} % ab, vorher um {before} %."
    ),
    "{count} flipped triangles unfolded; angles are off by {after} % on average, {before} % before.": (
        "{count} umgedrehte Dreiecke entfaltet; Winkel weichen im Mittel um {after} % ab, vorher um {before} %."
    ),
    "Parts that covered each other moved apart; angles are off by {after} % on average, {before} % before.": (
        "Teile, die einander überdeckten, auseinandergerückt; Winkel weichen im Mittel um {after} % ab, vorher um "
        "{before} %."
    ),
    "Parts that covered each other came apart in an embedding, relaxed without folding it; angles are off by "
    "{after} % on average, {before} % before.": (
        "Teile, die einander überdeckten, in einer Einbettung getrennt, die ohne Falten entspannt wurde; Winkel "
        "weichen im Mittel um {after} % ab, vorher um {before} %."
    ),
    "Parts that covered each other moved apart; angles are off by {after} % on average.": (
        "Teile, die einander überdeckten, auseinandergerückt; Winkel weichen im Mittel um {after} % ab."
    ),
    "The island still covers itself somewhere; add seams.": (
        "Die Insel überdeckt sich noch irgendwo selbst; Nähte hinzufügen."
    ),
    "{count} triangle could not be unfolded in double precision; add seams that make the island flatter.": (
        "{count} Dreieck ließ sich in doppelter Genauigkeit nicht entfalten; Nähte hinzufügen, die die Insel flacher "
        "machen."
    ),
    "{count} triangles could not be unfolded in double precision; add seams that make the island flatter.": (
        "{count} Dreiecke ließen sich in doppelter Genauigkeit nicht entfalten; Nähte hinzufügen, die die Insel "
        "flacher machen."
    ),
    "{count} triangle could not be unfolded between the pins; move or remove pins.": (
        "{count} Dreieck ließ sich zwischen den Pins nicht entfalten; Pins verschieben oder entfernen."
    ),
    "{count} triangle could not be unfolded beside straight edges and other constraints; remove some of them.": (
        "{count} Dreieck ließ sich neben geraden Kanten und anderen Bedingungen nicht entfalten; einige entfernen."
    ),
    "{count} triangles could not be unfolded beside straight edges and other constraints; remove some of them.": (
        "{count} Dreiecke ließen sich neben geraden Kanten und anderen Bedingungen nicht entfalten; einige entfernen."
    ),
    "Under the constraints, the map of least energy has flipped triangles; the one nearest to the unconstrained map "
    "replaces it.": (
        "Unter den Bedingungen hat die Abbildung kleinster Energie umgedrehte Dreiecke; genommen wurde die, die der "
        "Abbildung ohne Bedingungen am nächsten kommt."
    ),
    "Under the constraints, the map of least energy winds around {count} times; the one nearest to the unconstrained "
    "map replaces it.": (
        "Unter den Bedingungen läuft die Abbildung kleinster Energie {count}-mal um; genommen wurde die, die der "
        "Abbildung ohne Bedingungen am nächsten kommt."
    ),
    "{count} edge does not meet its constraint, because the UVs held there contradict it; hold fewer of them.": (
        "{count} Kante liegt nicht, wie ihre Bedingung verlangt, weil dort gehaltene UVs ihr widersprechen; "
        "weniger halten."
    ),
    "{count} edges do not meet their constraints, because the UVs held there contradict them; hold fewer.": (
        "{count} Kanten liegen nicht, wie ihre Bedingungen verlangen, weil dort gehaltene UVs ihnen widersprechen; "
        "weniger halten."
    ),
    "{count} triangles could not be unfolded between the pins; move or remove pins.": (
        "{count} Dreiecke ließen sich zwischen den Pins nicht entfalten; Pins verschieben oder entfernen."
    ),
    "The map goes around an inner vertex more than once; remove straight edges or other constraints.": (
        "Die Map läuft mehr als einmal um einen inneren Punkt; gerade Kanten oder andere Bedingungen entfernen."
    ),
    "The boundary of the map winds around {count} times instead of once; remove straight edges or other constraints.": (
        "Der Rand der Map läuft {count}-mal statt einmal um; gerade Kanten oder andere Bedingungen entfernen."
    ),
    "The map goes around an inner vertex more than once; add seams.": (
        "Die Map läuft mehr als einmal um einen inneren Punkt; Nähte hinzufügen."
    ),
    "The boundary of the map winds around {count} times instead of once; add seams.": (
        "Der Rand der Map läuft {count}-mal herum statt einmal; Nähte hinzufügen."
    ),
    "The map goes around an inner vertex more than once; move or remove pins.": (
        "Die Map läuft mehr als einmal um einen inneren Punkt; Pins verschieben oder entfernen."
    ),
    "The boundary of the map winds around {count} times instead of once; move or remove pins.": (
        "Der Rand der Map läuft {count}-mal herum statt einmal; Pins verschieben oder entfernen."
    ),
    "{count} triangle shrinks below what double precision resolves; add seams that make the island flatter.": (
        "{count} Dreieck schrumpft unter das, was doppelte Genauigkeit auflöst; Nähte hinzufügen, die die Insel "
        "flacher machen."
    ),
    "{count} triangles shrink below what double precision resolves; add seams that make the island flatter.": (
        "{count} Dreiecke schrumpfen unter das, was doppelte Genauigkeit auflöst; Nähte hinzufügen, die die Insel "
        "flacher machen."
    ),
    "{count} face wound the other way: reoriented.": ("{count} Fläche verkehrt herum: umgedreht."),
    "{count} faces wound the other way: reoriented.": ("{count} Flächen verkehrt herum: umgedreht."),
    "{count} duplicate face: placed on the first one with the same vertices.": (
        "{count} doppelte Fläche: auf die erste mit denselben Punkten gelegt."
    ),
    "{count} duplicate faces: placed on the first ones with the same vertices.": (
        "{count} doppelte Flächen: auf die ersten mit denselben Punkten gelegt."
    ),
    "{count} self-intersecting polygon: split as a fan.": (
        "{count} Polygon, das sich selbst schneidet: als Fächer geteilt."
    ),
    "{count} self-intersecting polygons: split as a fan.": (
        "{count} Polygone, die sich selbst schneiden: als Fächer geteilt."
    ),
    "{count} degenerate triangle: given a minimal height.": ("{count} entartetes Dreieck: bekam eine Mindesthöhe."),
    "{count} degenerate triangles: given a minimal height.": ("{count} entartete Dreiecke: bekamen eine Mindesthöhe."),
    "The island has no area: its map is a point.": ("Die Insel hat keinen Flächeninhalt: ihre Map ist ein Punkt."),
    "Faces with fewer than three different vertices, or with the same vertex twice in a row, cannot be unwrapped; "
    "delete them or merge their vertices.": (
        "Flächen mit weniger als drei verschiedenen Punkten, oder mit demselben Punkt zweimal nacheinander, lassen "
        "sich nicht abwickeln; sie löschen oder ihre Punkte verschmelzen."
    ),
    "There is too little memory for this island of {count} face; close other programs.": (
        "Für diese Insel aus {count} Fläche ist zu wenig Speicher frei; andere Programme schließen."
    ),
    "There is too little memory for this island of {count} faces; close other programs, or cut it into smaller ones "
    "with seams.": (
        "Für diese Insel aus {count} Flächen ist zu wenig Speicher frei; andere Programme schließen oder die Insel mit"
        " Nähten in kleinere teilen."
    ),
    "solved instead with thin triangles raised to a height of 1e-5 of their length.": (
        "stattdessen gelöst, wobei dünne Dreiecke eine Höhe von 1e-5 ihrer Länge bekamen."
    ),
    "solved with the boundary form 'length' instead.": ("stattdessen mit der Randform „length“ gelöst."),
    "solved with the boundary form 'vertex' instead.": ("stattdessen mit der Randform „vertex“ gelöst."),
    "solved with the weights 'uniform' instead.": ("stattdessen mit den Gewichten „uniform“ gelöst."),
    "solved with the weights 'inverse_area' instead.": ("stattdessen mit den Gewichten „inverse_area“ gelöst."),
    "replaced by an embedding, relaxed without folding it; angles are off by {after} % on average.": (
        "durch eine Einbettung ersetzt, die ohne Falten entspannt wurde; Winkel weichen im Mittel um {after} % ab."
    ),
    "replaced by an embedding that does not cover itself, relaxed without folding it; angles are off by {after} % "
    "on average.": (
        "durch eine Einbettung ersetzt, die sich nicht selbst überdeckt und ohne Falten entspannt wurde; Winkel "
        "weichen im Mittel um {after} % ab."
    ),
    "Vertex {count} has a coordinate that is not finite; give it a valid position or delete it.": (
        "Punkt {count} hat eine Koordinate, die nicht endlich ist; ihm eine gültige Position geben oder ihn löschen."
    ),
    "The island is non-orientable, like a Moebius strip; cut it with a seam.": (
        "Die Insel ist nicht orientierbar, wie ein Möbiusband; sie mit einer Naht aufschneiden."
    ),
    "The island is closed, with {count} handle: it has no boundary to unfold from; mark seams that cut it open.": (
        "Die Insel ist geschlossen, mit {count} Henkel: sie hat keinen Rand, von dem aus sie sich abwickeln lässt; "
        "Nähte markieren, die sie öffnen."
    ),
    "The island is closed, with {count} handles: it has no boundary to unfold from; mark seams that cut it open.": (
        "Die Insel ist geschlossen, mit {count} Henkeln: sie hat keinen Rand, von dem aus sie sich abwickeln lässt; "
        "Nähte markieren, die sie öffnen."
    ),
    "The island is closed: it has no boundary to unfold from; mark seams that cut it open.": (
        "Die Insel ist geschlossen: sie hat keinen Rand, von dem aus sie sich abwickeln lässt; Nähte markieren, die "
        "sie öffnen."
    ),
    "The island has {count} handle and cannot lie flat without overlap; mark seams that cut the handle open.": (
        "Die Insel hat {count} Henkel und kann nicht flach liegen, ohne sich zu überlappen; Nähte markieren, die ihn "
        "aufschneiden."
    ),
    "The island has {count} handles and cannot lie flat without overlap; mark seams that cut the handles open.": (
        "Die Insel hat {count} Henkel und kann nicht flach liegen, ohne sich zu überlappen; Nähte markieren, die sie "
        "aufschneiden."
    ),
    "The island has no extent that double precision can hold: all of its vertices coincide or lie too far apart; "
    "delete or rescale it.": (
        "Die Insel hat keine Ausdehnung, die doppelte Genauigkeit fasst: alle ihre Punkte fallen zusammen oder liegen "
        "zu weit auseinander; sie löschen oder skalieren."
    ),
    "The island's boundary has only two vertices, so no map can open between them; mark more seams.": (
        "Der Rand der Insel hat nur zwei Punkte, zwischen denen sich keine Map öffnen kann; mehr Nähte markieren."
    ),
    "The island has no area: its vertices lie on one line; delete it or move them apart.": (
        "Die Insel hat keinen Flächeninhalt: ihre Punkte liegen auf einer Linie; sie löschen oder die Punkte "
        "auseinanderrücken."
    ),
    "The area blend evened out sizes only a little: they vary by {after} %, {before} % before": (
        "Der Flächenausgleich hat die Größen wenig angeglichen: sie schwanken um {after} %, vorher um {before} %"
    ),
    "The area blend did not even out sizes: they vary by {after} %, {before} % before": (
        "Der Flächenausgleich hat die Größen nicht angeglichen: sie schwanken um {after} %, vorher um {before} %"
    ),
    "{blend}. Add seams, or clean up degenerate faces.": (
        "{blend}. Nähte hinzufügen oder entartete Flächen bereinigen."
    ),
    "{blend}. Its relaxation reached its limit of factorizations; add seams, or clean up degenerate faces.": (
        "{blend}. Seine Entspannung endete an ihrer Grenze von Faktorisierungen; Nähte hinzufügen oder entartete "
        "Flächen bereinigen."
    ),
    "{blend}. Flipped or degenerate triangles stopped its relaxation; add seams, or clean up degenerate faces.": (
        "{blend}. Umgedrehte oder entartete Dreiecke hielten seine Entspannung auf; Nähte hinzufügen oder entartete "
        "Flächen bereinigen."
    ),
    "{blend}. Its relaxation failed; add seams, or clean up degenerate faces.": (
        "{blend}. Seine Entspannung schlug fehl; Nähte hinzufügen oder entartete Flächen bereinigen."
    ),
    "The conformal energy could not be factorized, even with a shift of {after} of the boundary form": (
        "Die konforme Energie ließ sich nicht faktorisieren, auch nicht mit einer Verschiebung um {after} der Randform"
    ),
    "The eigenvalue iteration did not converge": ("Die Iteration des Eigenwerts konvergierte nicht"),
    "The map is not finite": ("Die Map ist nicht endlich"),
    "The map shrinks the boundary to a point": ("Die Map lässt den Rand zu einem Punkt schrumpfen"),
    "The triangles differ so much in size or shape that double precision does not resolve the map": (
        "Die Dreiecke sind so verschieden groß oder geformt, dass doppelte Genauigkeit die Map nicht auflöst"
    ),
    "The map has no positive area": ("Die Map hat keinen positiven Flächeninhalt"),
    "The boundary of the map winds around {count} times instead of once": (
        "Der Rand der Map läuft {count}-mal herum statt einmal"
    ),
    "The map folds over at {count} of its triangles": ("Die Map faltet sich an {count} ihrer Dreiecke um"),
    "No embedding into a circle could be solved for in double precision": (
        "Eine Einbettung in einen Kreis ließ sich in doppelter Genauigkeit nicht lösen"
    ),
    "The island is too large: its factor would have more than {count} entries": (
        "Die Insel ist zu groß: ihr Faktor hätte mehr als {count} Einträge"
    ),
    "This build has no CHOLMOD; install SuiteSparse and build again, or use 'eigen'.": (
        "Dieser Build hat kein CHOLMOD; SuiteSparse installieren und neu bauen, oder „eigen“ verwenden."
    ),
    "CHOLMOD reported status {count}": ("CHOLMOD meldete den Status {count}"),
    "The pinned conformal energy is singular in double precision": (
        "Die konforme Energie mit Pins ist in doppelter Genauigkeit singulär"
    ),
    "The pinned map is not finite": ("Die Map mit Pins ist nicht endlich"),
    "The pinned map shrinks the boundary to a point": ("Die Map mit Pins lässt den Rand zu einem Punkt schrumpfen"),
    "The pinned map does not satisfy its equations in double precision": (
        "Die Map mit Pins erfüllt ihre Gleichungen in doppelter Genauigkeit nicht"
    ),
    "The pinned map has no positive area": ("Die Map mit Pins hat keinen positiven Flächeninhalt"),
    "Face {count} has fewer than three different vertices; remove it.": (
        "Fläche {count} hat weniger als drei verschiedene Punkte; sie entfernen."
    ),
    "The mesh has no faces; there is nothing to parameterize.": (
        "Das Mesh hat keine Flächen; es gibt nichts abzuwickeln."
    ),
    "Edges with three or more faces: {count}; split the mesh there, or use unwrap, which does.": (
        "Kanten mit drei oder mehr Flächen: {count}; das Mesh dort trennen oder unwrap verwenden, das es tut."
    ),
    "The mesh has {count} separate components; pass one at a time, or use unwrap, which takes them all.": (
        "Das Mesh hat {count} Teile, die keine Kante verbindet; eines nach dem anderen angeben oder unwrap "
        "verwenden, das alle nimmt."
    ),
    "Vertices where parts of the boundary touch (bow ties): {count}; split them, or use unwrap, which does.": (
        "Punkte, an denen sich Teile des Randes berühren: {count}; sie trennen oder unwrap verwenden, das es tut."
    ),
    "The mesh has {count} vertices; at most {limit} can be numbered. Split it into several meshes.": (
        "Das Mesh hat {count} Punkte; höchstens {limit} lassen sich nummerieren. Es in mehrere teilen."
    ),
    "The mesh has {count} faces; at most {limit} can be numbered. Split it into several meshes.": (
        "Das Mesh hat {count} Flächen; höchstens {limit} lassen sich nummerieren. Es in mehrere teilen."
    ),
    "The mesh has {count} face corners; at most {limit} can be numbered. Split it into several meshes.": (
        "Das Mesh hat {count} Flächenecken; höchstens {limit} lassen sich nummerieren. Es in mehrere teilen."
    ),
    "The mesh has {count} seam edges; at most {limit} can be numbered. Split it into several meshes.": (
        "Das Mesh hat {count} Nahtkanten; höchstens {limit} lassen sich nummerieren. Es in mehrere teilen."
    ),
    "face_offsets must not decrease, but they do after face {count}.": (
        "face_offsets darf nicht fallen, fällt aber nach Fläche {count}."
    ),
    "face_offsets must start with 0.": ("face_offsets muss mit 0 beginnen."),
    "Corner {count} refers to vertex {index}, but there are {limit} vertices.": (
        "Ecke {count} verweist auf Punkt {index}, aber es gibt {limit} Punkte."
    ),
    "Seam edge {count} refers to vertex {index}, but there are {limit} vertices.": (
        "Nahtkante {count} verweist auf Punkt {index}, aber es gibt {limit} Punkte."
    ),
    "Face {count} is not a triangle.": ("Fläche {count} ist kein Dreieck."),
    "The UV of corner {count} (face {index}) is not finite; leave its face out of the selection or give it "
    "coordinates.": (
        "Der UV-Punkt der Ecke {count} (Fläche {index}) ist nicht endlich; ihre Fläche nicht auswählen oder ihr "
        "Koordinaten geben."
    ),
    "A pinned UV of face {count} is not finite; unpin it or give it a valid position.": (
        "Ein gepinnter UV-Punkt der Fläche {count} ist nicht endlich; den Pin lösen oder ihm eine gültige Position "
        "geben."
    ),
    "The metric of face {count} is not positive definite in double precision; both of its eigenvalues must be "
    "positive.": (
        "Die Metrik der Fläche {count} ist in doppelter Genauigkeit nicht positiv definit; ihre beiden Eigenwerte "
        "müssen positiv sein."
    ),
    "The island's longest boundary loop has no length; clean up its coincident vertices.": (
        "Die längste Randschleife der Insel hat keine Länge; ihre zusammenfallenden Punkte bereinigen."
    ),
    "Vertex {count} is pinned, but no triangle uses it.": (
        "Punkt {count} ist gepinnt, aber kein Dreieck verwendet ihn."
    ),
    "Vertex {count} has an extender, but no triangle uses it.": (
        "Punkt {count} hat einen Extender, aber kein Dreieck verwendet ihn."
    ),
    "All pins have the same position, so the map would shrink to a point; move one of them.": (
        "Alle Pins haben dieselbe Position, so dass die Map zu einem Punkt schrumpfen würde; einen davon verschieben."
    ),
    "The mesh has too many vertices with several pins; unpin some.": (
        "Das Mesh hat zu viele Punkte mit mehreren Pins; einige lösen."
    ),
    "The methods 'fiedler' and 'area' hold at most two pins; use 'spectral' or 'lscm', or remove all pins but two.": (
        "Die Methoden „fiedler“ und „area“ halten keine drei Pins; „spectral“ oder „lscm“ verwenden oder alle Pins "
        "bis auf zwei entfernen."
    ),
    "Straight edges and other constraints need the method 'spectral'.": (
        "Gerade Kanten und andere Bedingungen brauchen die Methode „spectral“."
    ),
    "The constraints give vertices {count} and {index} of one edge the same position; remove one of them.": (
        "Die Bedingungen geben den Punkten {count} und {index} einer Kante dieselbe Position; eine davon entfernen."
    ),
    "The constraints put all corners of the triangle of vertices {count}, {index} and {limit} on one line; remove "
    "one of them.": (
        "Die Bedingungen legen alle Ecken des Dreiecks der Punkte {count}, {index} und {limit} auf eine Linie; eine "
        "davon entfernen."
    ),
    "Extenders and hole rigidity need the method 'spectral'; hole rigidity also needs a map that nothing holds, so "
    "make the pins soft.": (
        "Extender und die Steifheit der Löcher brauchen die Methode „spectral“, die Steifheit auch, dass nichts "
        "festgehalten wird; die Pins weich machen."
    ),
    "{reason}, in {attempts} attempts with different shifts and starts": (
        "{reason}, in {attempts} Versuchen mit verschiedenen Verschiebungen und Anfängen"
    ),
    "cut it into smaller islands with seams.": ("sie mit Nähten in kleinere Inseln teilen."),
    "please report this with the mesh.": ("bitte mit dem Mesh melden."),
    "add seams that make the island flatter.": ("Nähte hinzufügen, die die Insel flacher machen."),
    "the island has too many degenerate triangles; merge vertices by distance or dissolve degenerate faces.": (
        "die Insel hat zu viele entartete Dreiecke; Punkte nach Abstand verschmelzen oder entartete Flächen auflösen."
    ),
    "add seams that make the island flatter, or clean up degenerate faces.": (
        "Nähte hinzufügen, die die Insel flacher machen, oder entartete Flächen bereinigen."
    ),
    "the island has degenerate triangles or pins that coincide in 3D; clean the mesh or pin other vertices.": (
        "die Insel hat entartete Dreiecke oder Pins, die in 3D zusammenfallen; das Mesh bereinigen oder andere Punkte "
        "pinnen."
    ),
    "pin other vertices, or merge vertices by distance.": (
        "andere Punkte pinnen oder Punkte nach Abstand verschmelzen."
    ),
    "use the spectral method, or pin other vertices.": ("die Methode „Spektral“ verwenden oder andere Punkte pinnen."),
    "move or remove pins.": ("Pins verschieben oder entfernen."),
    "clean up degenerate faces, cut an island that is very long, or pin other vertices.": (
        "entartete Flächen bereinigen, eine sehr lange Insel teilen oder andere Punkte pinnen."
    ),
    "lower the hole rigidity.": ("die Steifheit der Löcher senken."),
    "weaken or remove extenders (Push/Pull).": ("Extender (Drücken/Ziehen) schwächen oder entfernen."),
    "remove straight edges or other constraints, or clean up degenerate faces.": (
        "gerade Kanten oder andere Bedingungen entfernen, oder entartete Flächen bereinigen."
    ),
    "weaken or remove extenders (Push/Pull), or lower the hole rigidity.": (
        "Extender (Drücken/Ziehen) schwächen oder entfernen, oder die Steifheit der Löcher senken."
    ),
    "{reason}: {consequence}": ("{reason}: {consequence}"),
    # What does not run.
    "The compiled module spectral_conformal cannot be imported; install the Spectral Unwrap package for this "
    "platform and Blender version ({reason})": (
        "Das kompilierte Modul spectral_conformal lässt sich nicht importieren; das Paket von Spectral Unwrap für "
        "dieses System und diese Version von Blender installieren ({reason})"
    ),
    "The margin must be a number, not {margin}": "Der Rand muss eine Zahl sein, nicht {margin}",
    "{n} island had no former bounds and was packed into the UV tile": (
        "{n} Insel hatte keinen früheren UV-Bereich und wurde in die UV-Kachel gepackt"
    ),
    "{n} islands had no former bounds and were packed into the UV tile": (
        "{n} Inseln hatten keinen früheren UV-Bereich und wurden in die UV-Kachel gepackt"
    ),
}
