# SPDX-License-Identifier: GPL-3.0-or-later
"""What operators report: what cannot be done and why, and what came of it."""

REPORTS = {
    # Characters
    '"{name}" has no bones': "„{name}“ hat keine Knochen",
    '"{name}" has no bones to draw a body around': (
        "„{name}“ hat keine Knochen, um die ein Körper gezeichnet werden könnte"
    ),
    '"{name}" has no bone "{bone}" any more: bake again': (
        "„{name}“ hat den Knochen „{bone}“ nicht mehr: noch einmal rekonstruieren"
    ),
    '"{name}" has no bone {bone}: untick "Reuse armature"': (
        "„{name}“ hat keinen Knochen {bone}: „Armatur weiterverwenden“ abwählen"
    ),
    '"{name}" has other proportions than this motion database: untick "Reuse armature"': (
        "„{name}“ hat andere Proportionen als diese Bewegungsdatenbank: „Armatur "
        "weiterverwenden“ abwählen"
    ),
    '"{name}" has a negative scale: apply the scale (Ctrl A)': (
        "„{name}“ ist gespiegelt skaliert: die Skalierung anwenden (Strg A)"
    ),
    '"{name}" is scaled unevenly: apply the scale (Ctrl A)': (
        "„{name}“ ist ungleichmäßig skaliert: die Skalierung anwenden (Strg A)"
    ),
    '"{name}": its body does not hang on one bone: parent its bones': (
        "„{name}“: der Körper hängt nicht an einem Knochen: seine Knochen verbinden"
    ),
    '"{name}": the bone "{bone}" cannot be moved, it is held by a constraint': (
        "„{name}“: der Knochen „{bone}“ lässt sich nicht bewegen, ein Constraint hält ihn"
    ),
    '"{name}" is hidden: show it in the viewport first': (
        "„{name}“ ist verborgen: zuerst im Viewport einblenden"
    ),
    '"{name}" is in Edit Mode: leave it first': (
        "„{name}“ ist im Bearbeitungsmodus: ihn zuerst verlassen"
    ),
    '"{name}" shows its rest position: switch to Pose Position': (
        "„{name}“ zeigt die Ruheposition: auf Pose-Position umschalten"
    ),
    '"{name}" is linked from another file: make it local first': (
        "„{name}“ ist aus einer anderen Datei verknüpft: zuerst lokal machen"
    ),
    '"{name}" is a library override that is not editable: make it editable first': (
        "„{name}“ ist ein Library Override, das nicht bearbeitet werden kann: zuerst bearbeitbar "
        "machen"
    ),
    '"{name}" is being tweaked in the NLA editor: leave tweak mode first': (
        "„{name}“ wird gerade im NLA-Editor angepasst: zuerst den Tweak-Modus verlassen"
    ),
    '"{name}" plays no action to compare with': "„{name}“ spielt keine Action zum Vergleichen",
    'The character "{name}" is gone: choose another one': (
        "Den Charakter „{name}“ gibt es nicht mehr: einen anderen wählen"
    ),
    'There is no Sparse Mocap armature to reuse: untick "Reuse armature"': (
        "Es gibt keine Armatur von Sparse Mocap: „Armatur weiterverwenden“ abwählen"
    ),
    "There are several Sparse Mocap armatures: select the one for the take": (
        "Es gibt mehrere Armaturen von Sparse Mocap: die für die Aufnahme auswählen"
    ),
    "Several Sparse Mocap figures are chosen: choose one of them": (
        "Mehrere Figuren von Sparse Mocap sind gewählt: eine davon wählen"
    ),
    "New objects are hidden in this view layer: include the scene collection": (
        "Neue Objekte sind in diesem View Layer verborgen: die Szenen-Collection einschließen"
    ),
    "Leave {mode} first": "Zuerst {mode} verlassen",
    "Select a character first": "Zuerst einen Charakter auswählen",
    "Choose a character first": "Zuerst einen Charakter wählen",
    "Select a bone of the character in Pose Mode first": (
        "Zuerst im Pose-Modus einen Knochen des Charakters auswählen"
    ),
    "There is no skeleton to map: choose a character or import a motion file": (
        "Es gibt kein Skelett zum Zuordnen: einen Charakter wählen oder eine Bewegung importieren"
    ),
    '{standard}: "{name}" has no joint "{joint}", choose another one': (
        "{standard}: „{name}“ hat kein Gelenk „{joint}“, ein anderes wählen"
    ),
    # Takes and results
    "Select a character that plays a take first": (
        "Zuerst einen Charakter auswählen, der eine Aufnahme spielt"
    ),
    "Select a character with a take that was reconstructed since Blender was started": (
        "Einen Charakter mit einer Aufnahme auswählen, die seit dem Start rekonstruiert wurde"
    ),
    "The take's result is from an earlier session: press Reconstruct": (
        "Das Ergebnis der Aufnahme ist von früher: Rekonstruieren drücken"
    ),
    "Choose the action to compare with": "Die Action wählen, mit der verglichen wird",
    "This take has no alternative {letter}: tick Alternatives and press Reconstruct": (
        "Diese Aufnahme hat keine Alternative {letter}: Alternativen ankreuzen und Rekonstruieren "
        "drücken"
    ),
    "The active object has no ghost": "Das aktive Objekt hat keinen Ghost",
    "No part of this take has a poor match": "Kein Teil dieser Aufnahme passt schlecht",
    "There is nothing from {begin} to {end} s: the take is {length} s long": (
        "Von {begin} bis {end} s ist nichts: die Aufnahme ist {length} s lang"
    ),
    '"{part}" is not NAME=VALUE, for example: num_paths=128': (
        "„{part}“ ist nicht NAME=WERT, zum Beispiel: num_paths=128"
    ),
    "There is no preview to keep: preview a clip first": (
        "Es gibt keine Vorschau zum Behalten: zuerst einen Clip ansehen"
    ),
    "There is no preview: preview a clip first": (
        "Es gibt keine Vorschau: zuerst einen Clip ansehen"
    ),
    "There is no clip {number}: the motion database has {count} clips": (
        "Es gibt keinen Clip {number}: die Bewegungsdatenbank hat {count} Clips"
    ),
    # Files
    "Choose a {kind} first": "Zuerst wählen: {kind}",
    "The path of the {kind} contains an invalid character: choose the file again": (
        "Der Pfad enthält ein ungültiges Zeichen ({kind}): die Datei neu wählen"
    ),
    "{path} is a folder: choose a {kind} file": "{path} ist ein Ordner: eine Datei wählen ({kind})",
    "{path} is a folder: choose a {suffix} file to save to": (
        "{path} ist ein Ordner: eine {suffix}-Datei zum Speichern wählen"
    ),
    "{path} is a folder: choose a file that ends in {suffix}": (
        "{path} ist ein Ordner: eine Datei wählen, die auf {suffix} endet"
    ),
    "{path} does not end in {suffix}: choose another file": (
        "{path} endet nicht auf {suffix}: eine andere Datei wählen"
    ),
    "{path} does not exist: choose a folder with motion files": (
        "{path} gibt es nicht: einen Ordner mit Bewegungsdateien wählen"
    ),
    "Choose a file that ends in {suffix}": "Eine Datei wählen, die auf {suffix} endet",
    "Choose a {suffix} file to save to": "Eine {suffix}-Datei zum Speichern wählen",
    "There is no folder {folder}: choose where to save {name}": (
        "Den Ordner {folder} gibt es nicht: wählen, wo {name} gespeichert wird"
    ),
    "Choose a folder with motion files (.bvh, or .amc with .asf) first": (
        "Zuerst einen Ordner mit Bewegungsdateien wählen (.bvh, oder .amc mit .asf)"
    ),
    "No armature in this file has an action that moves its bones": (
        "Keine Armatur in dieser Datei hat eine Action, die ihre Knochen bewegt"
    ),
    "No armature in this scene has an action that moves its bones: import some motion": (
        "Keine Armatur in dieser Szene hat eine Action, die ihre Knochen bewegt: eine Bewegung "
        "importieren"
    ),
    "There is no report yet: build a motion database first": (
        "Es gibt noch keinen Bericht: zuerst eine Bewegungsdatenbank erstellen"
    ),
    "motion database": "Bewegungsdatenbank",
    "take": "Aufnahme",
    "calibration": "Kalibrierung",
    "motion file": "Bewegungsdatei",
    # Sensors
    "No sensors are connected: press Connect first": (
        "Keine Sensoren sind verbunden: zuerst Verbinden drücken"
    ),
    "Nothing is being recorded: press Record first": (
        "Es wird nichts aufgenommen: zuerst Aufnehmen drücken"
    ),
    "There is no live preview: press Live Preview first": (
        "Es gibt keine Live-Vorschau: zuerst Live-Vorschau drücken"
    ),
    "This capture has ended: refresh the ports and connect again": (
        "Dieser Empfang ist beendet: die Ports aktualisieren und neu verbinden"
    ),
    "The sensors do not respond: disconnect and connect again": (
        "Die Sensoren antworten nicht: trennen und neu verbinden"
    ),
    "The sensors were disconnected": "Die Sensoren wurden getrennt",
    "{label} is still connected: press Disconnect first": (
        "{label} ist noch verbunden: zuerst Trennen drücken"
    ),
    "A recording is running: stop it before you calibrate": (
        "Eine Aufnahme läuft: sie vor dem Kalibrieren beenden"
    ),
    "No tracker sent data in all poses: check the trackers and calibrate again": (
        "Kein Tracker sendete in allen Posen: nach ihnen sehen und neu kalibrieren"
    ),
    "Choose the port of the sensors first": "Zuerst den Port der Sensoren wählen",
    "{port} is in the list twice: remove one": "{port} steht zweimal in der Liste: eins entfernen",
    "{port}: cannot be used": "{port}: kann nicht benutzt werden",
    'Unknown sensor location "{site}": choose one from the menu': (
        "Unbekannter Sensorort „{site}“: einen aus dem Menü wählen"
    ),
    'Unknown sensor location "{site}": choose from {known}': (
        "Unbekannter Sensorort „{site}“: möglich sind {known}"
    ),
    'Unknown sensor location "{site}": enter where it is worn': (
        "Unbekannter Sensorort „{site}“: eingeben, wo er getragen wird"
    ),
    'Option "{word}": write name=value, separated by commas': (
        "Option „{word}“: als name=wert schreiben, durch Kommas getrennt"
    ),
    "{reason}; what was received is in {folder}": (
        "{reason}; was empfangen wurde, liegt in {folder}"
    ),
    "Real sensors need the Python package {name}: install it in Blender's Python": (
        "Echte Sensoren brauchen das Python-Paket {name}: in Blenders Python installieren"
    ),
    "Sensors on a network need Blender's permission: turn on Allow Online Access in "
    "Preferences > System, and connect again": (
        "Sensoren im Netzwerk brauchen Blenders Erlaubnis: in Preferences > System den "
        "Online-Zugriff erlauben und neu verbinden"
    ),
    "Choose where the sensors are worn: no sensor has a sensor location": (
        "Wählen, wo die Sensoren getragen werden: keiner hat einen Sensorort"
    ),
    "No readings for {seconds} s": "Seit {seconds} s keine Messwerte",
    "No readings for {seconds} s: {reason}": "Seit {seconds} s keine Messwerte: {reason}",
    "Live preview ended: its character is gone": (
        "Live-Vorschau beendet: ihren Charakter gibt es nicht mehr"
    ),
    'Live preview ended: "{name}" was given an action': (
        "Live-Vorschau beendet: „{name}“ bekam eine Action"
    ),
    'Live preview ended: "{name}" has no bone "{bone}" any more': (
        "Live-Vorschau beendet: „{name}“ hat den Knochen „{bone}“ nicht mehr"
    ),
    # Models and the phone
    "Select a clip in the list of clips first": "Zuerst einen Clip in der Liste auswählen",
    "This model is for {method}, not for {wanted}: open another one, or change the method": (
        "Dieses Modell ist für {method}, nicht für {wanted}: ein anderes öffnen oder die Methode "
        "wechseln"
    ),
    "The recording has {count} sensors, and one phone is expected: convert it with "
    "`sparse-mocap import`": (
        "Die Aufnahme hat {count} Sensoren, erwartet wird ein Telefon: mit `sparse-mocap import` "
        "umwandeln"
    ),
    "Choose where to save the model first": "Zuerst wählen, wo das Modell gespeichert wird",
    "The folder {folder} does not exist: choose another one": (
        "Den Ordner {folder} gibt es nicht: einen anderen wählen"
    ),
    "The file of phases has a clip that is not trained from: {name}": (
        "Die Datei der Phasen hat einen Clip, aus dem nicht gelernt wird: {name}"
    ),
    "Training from: {clips}": "Gelernt wird aus: {clips}",
    "The phases of {count} clips are in {path}": "Die Phasen von {count} Clips stehen in {path}",
    "Live Sensors is set up for a phone: press Connect there": (
        "Sensoren live ist für ein Telefon eingestellt: dort Verbinden drücken"
    ),
    "Saved as {path}": "Gespeichert als {path}",
    # Whatever is done
    "A render is running: wait until it has finished": (
        "Ein Rendering läuft: warten, bis es fertig ist"
    ),
    "{job} is still running: wait or cancel it first": (
        "{job} läuft noch: warten oder zuerst abbrechen"
    ),
    "Cancelled": "Abgebrochen",
    "The scene changed in the meantime, so nothing was done: try again": (
        "Die Szene hat sich inzwischen geändert, nichts wurde getan: noch einmal versuchen"
    ),
    "Not enough memory: close other programs, or use fewer or shorter files": (
        "Nicht genug Speicher: andere Programme schließen oder weniger oder kürzere Dateien nehmen"
    ),
    "Unexpected {kind}: {text}": "Unerwartet {kind}: {text}",
    '"{name}": {reason}': "„{name}“: {reason}",
    # Warnings
    "The motion database has nothing like this take, so the motion is a guess": (
        "Die Bewegungsdatenbank enthält nichts Ähnliches, die Bewegung ist also geraten"
    ),
    "Not reconstructed: {reason}": "Nicht rekonstruiert: {reason}",
    '"{name}": held by constraints or drivers and may not follow: {bones}': (
        "„{name}“: von Constraints oder Drivern gehalten, folgt vielleicht nicht: {bones}"
    ),
    # What came of it
    '"{action}" is up to date': "„{action}“ ist aktuell",
    '"{action}" is a strip in the NLA': "„{action}“ ist ein Strip im NLA-Editor",
    '"{name}" plays "{action}"': "„{name}“ spielt „{action}“",
    "The ghost is removed": "Der Ghost ist entfernt",
    "Poor from {begin} to {end} s of the take": "Schlecht von {begin} bis {end} s der Aufnahme",
    "Calibrated {count} trackers, saved as {path}": (
        "{count} Tracker kalibriert, gespeichert als {path}"
    ),
    "Calibrated {count} sensors, saved as {path}": (
        "{count} Sensoren kalibriert, gespeichert als {path}"
    ),
    'Previewing "{clip}" on "{name}"': "Vorschau von „{clip}“ auf „{name}“",
    "Playback loops frames {first} to {last}": "Die Wiedergabe wiederholt Bild {first} bis {last}",
    'Kept "{action}" on "{name}"': "„{action}“ auf „{name}“ behalten",
    'Live preview on "{name}"': "Live-Vorschau auf „{name}“",
    "Recording": "Nimmt auf",
    "Nothing was recorded": "Nichts wurde aufgenommen",
    "Take saved as {path}": "Aufnahme gespeichert als {path}",
    '"{action}" on "{name}"; take saved as {path}': (
        "„{action}“ auf „{name}“; Aufnahme gespeichert als {path}"
    ),
    '"{action}" on "{name}": {seconds} s, sensors match: {match}': (
        "„{action}“ auf „{name}“: {seconds} s, Übereinstimmung: {match}"
    ),
    'Mapped {count} bones of "{name}"': "{count} Knochen von „{name}“ zugeordnet",
    "{joint}: {bone}": "{joint}: {bone}",
    'Mapping remembered for every skeleton like that of "{name}"': (
        "Zuordnung gemerkt für alle Skelette wie das von „{name}“"
    ),
    "Mapping forgotten; the joints are detected automatically again": (
        "Zuordnung vergessen; die Gelenke werden wieder selbst erkannt"
    ),
    "Saved {path}": "{path} gespeichert",
    "Mapping loaded: press Remember to use it": ("Zuordnung geladen: mit Merken wird sie benutzt"),
    "The starter set is {path}": "Der Startsatz ist {path}",
    '"{name}" does what four simulated sensors say that "{performer}" does; match: {match}': (
        "„{name}“ tut, was „{performer}“ laut vier simulierten Sensoren tut; "
        "Übereinstimmung: {match}"
    ),
    "Loaded a take of {count} sensors, {seconds} s": (
        "Aufnahme mit {count} Sensoren geladen, {seconds} s"
    ),
    "Built a database of {clips} clips from {files} files": (
        "Datenbank aus {clips} Clips von {files} Dateien erstellt"
    ),
    "Built a database of {clips} clips from {files} files, {skipped} skipped": (
        "Datenbank aus {clips} Clips von {files} Dateien erstellt, {skipped} übersprungen"
    ),
    "Built a database of {clips} clips from {actions} actions": (
        "Datenbank aus {clips} Clips von {actions} Actions erstellt"
    ),
    "Built a database of {clips} clips from {actions} actions, {skipped} skipped": (
        "Datenbank aus {clips} Clips von {actions} Actions erstellt, {skipped} übersprungen"
    ),
    "Imported {files} files, each on its own armature": (
        "{files} Dateien importiert, jede auf einer eigenen Armatur"
    ),
    "Imported {files} files, each on its own armature, {skipped} left out": (
        "{files} Dateien importiert, jede auf einer eigenen Armatur, {skipped} ausgelassen"
    ),
    'Imported "{name}": {joints} joints, {frames} frames': (
        "„{name}“ importiert: {joints} Gelenke, {frames} Bilder"
    ),
    'Imported "{name}": {joints} joints, rest pose': (
        "„{name}“ importiert: {joints} Gelenke, Ruhepose"
    ),
    "and {count} more warnings": "und {count} weitere Warnungen",
    "Trained a model on {clips} clips": "Modell aus {clips} Clips gelernt",
    "Trained a model on {clips} clips of {types} types of motion": (
        "Modell aus {clips} Clips von {types} Bewegungsarten gelernt"
    ),
    "The motion has positions or rotations that are not finite numbers": (
        "Die Bewegung hat Positionen oder Drehungen, die keine endlichen Zahlen sind"
    ),
    "{count} more takes in {folder}": "{count} weitere Aufnahmen in {folder}",
    '"{name}" is not listed any more': "„{name}“ steht nicht mehr in der Liste",
    '"{body}" moves with "{name}"': "„{body}“ bewegt sich mit „{name}“",
    "Copied the report": "Bericht kopiert",
    'The report is in the text "{name}" and on the clipboard': (
        "Der Bericht steht im Text „{name}“ und in der Zwischenablage"
    ),
}
