# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender shows of trained models and of one phone."""

MODELS = {
    "Train a model on the chosen clips of the motion database, and use it": (
        "Aus den gewählten Clips der Bewegungsdatenbank ein Modell lernen und es verwenden"
    ),
    "The .smmodel file to write": "Die .smmodel-Datei, die geschrieben wird",
    "Open a trained model (.smmodel)": "Ein trainiertes Modell (.smmodel) öffnen",
    "The trained model (.smmodel) to reconstruct with": (
        "Das trainierte Modell (.smmodel), mit dem rekonstruiert wird"
    ),
    "Add the clip that is selected in the list of clips": (
        "Von dem Clip lernen, der in der Liste der Clips gewählt ist"
    ),
    "Write to a file where the phases of the chosen clips begin. Change the times in a text "
    "editor or a spreadsheet, and train again": (
        "In eine Datei schreiben, wo die Phasen der gewählten Clips beginnen. Die Zeiten in einem "
        "Texteditor oder einer Tabellenkalkulation ändern und neu trainieren"
    ),
    "Load a recording of one phone, as phyphox and Sensor Logger export it (.zip or .csv), "
    "as a take": (
        "Was ein Telefon aufgezeichnet hat, wie phyphox und Sensor Logger es exportieren (.zip "
        "oder .csv), als Aufnahme laden"
    ),
    "Set Live Sensors up for an app that sends a line of time, accelerometer (m/s²) and "
    "gyroscope (rad/s) for each sample to UDP port 5005 of this computer": (
        "Sensoren live für eine App einrichten, die für jeden Messwert eine Zeile aus Zeit, "
        "Beschleunigung (m/s²) und Drehrate (rad/s) an den UDP-Port 5005 dieses Computers sendet"
    ),
    "Show in the viewport what the model knows: a point for each frame in the colour of its "
    "phase, and where the live motion is": (
        "Im Viewport zeigen, was das Modell kennt: ein Punkt für jeden Frame in der Farbe seiner "
        "Phase, und wo die Bewegung gerade ist"
    ),
    "Classes of the motion database to learn from, separated by commas. Each becomes a "
    "type of motion, and takes are recognised as one of them. Empty: all": (
        "Klassen der Bewegungsdatenbank, von denen gelernt wird, durch Kommas getrennt. Jede wird "
        "eine Art von Bewegung, und Aufnahmen werden als eine davon erkannt. Leer: alle"
    ),
    "Names of clips to learn from, separated by commas, for example: walk_01, run*. "
    "One or two clips of each type are enough. Empty: all of the classes": (
        "Namen von Clips, von denen gelernt wird, durch Kommas getrennt, zum Beispiel: walk_01, "
        "run*. Ein oder zwei Clips jeder Art genügen. Leer: alle der Klassen"
    ),
    "A file (.csv) that says where the phases of the clips begin, as Write Phases makes "
    "it. Empty: found by the feet that leave the floor": (
        "Eine Datei (.csv), in der steht, wo die Phasen der Clips beginnen, wie sie Phasen "
        "schreiben macht. Leer: nach den Füßen, die den Boden verlassen"
    ),
    "The model file to write. Empty: next to the motion database": (
        "Die Modelldatei, die geschrieben wird. Leer: neben der Bewegungsdatenbank"
    ),
    "Where the phone is worn": "Wo das Telefon getragen wird",
    "At the left ankle": "Am linken Knöchel",
    "At the right ankle": "Am rechten Knöchel",
    "At the left wrist": "Am linken Handgelenk",
    "At the right wrist": "Am rechten Handgelenk",
    "At the pelvis": "Am Becken",
}
