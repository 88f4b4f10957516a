# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences in panels and viewports."""

SENTENCES = {
    "New here?": "Neu hier?",
    "A simulated performer with four simulated sensors, and a Rigify character that follows: "
    "no file and no sensor is needed": (
        "Ein simulierter Darsteller mit vier simulierten Sensoren, und ein Rigify-Charakter, der "
        "ihm folgt: ganz ohne Datei und Sensor"
    ),
    "Demo movements, made by a program, to try things out": (
        "Demobewegungen, von einem Programm gemacht, zum Ausprobieren"
    ),
    "Open a motion database (.smdb), or build one:": (
        "Eine Bewegungsdatenbank (.smdb) öffnen oder erstellen:"
    ),
    "Motion capture to download": "Zum Herunterladen",
    "Free for any use but selling the data; name mocap.cs.cmu.edu and NSF EIA-0196217": (
        "Frei für alles außer dem Verkauf der Daten; mocap.cs.cmu.edu und NSF EIA-0196217 nennen"
    ),
    "CC BY-SA 3.0; cite Müller et al., Mocap Database HDM05": (
        "CC BY-SA 3.0; Müller et al., Mocap Database HDM05 zitieren"
    ),
    "CC BY-NC 4.0: not for commercial work": "CC BY-NC 4.0: nicht für kommerzielle Arbeiten",
    "Will be saved as {path}": "Wird gespeichert als {path}",
    "{files} files: {skipped} skipped, {warnings} warnings": (
        "{files} Dateien: {skipped} ausgelassen, {warnings} Warnungen"
    ),
    "and {count} more": "und {count} weitere",
    "Previewing {name}": "Vorschau von {name}",
    "Load a recorded take (.csv), or record one": (
        "Eine Aufnahme (.csv) laden oder selbst aufnehmen"
    ),
    "Empty: the add-on makes a figure": "Leer: das Add-on macht eine Figur",
    "Choose a motion database first": "Zuerst eine Bewegungsdatenbank wählen",
    "Choose a folder with motion files first": "Zuerst einen Ordner mit Bewegungsdateien wählen",
    "Choose a port first": "Zuerst einen Port wählen",
    "Stop the recording first": "Zuerst die Aufnahme beenden",
    "Waits for: {job}": "Wartet auf: {job}",
    "{count} sensors": "{count} Sensoren",
    "Choose a take first": "Zuerst eine Aufnahme wählen",
    "Train or open a model first": "Zuerst ein Modell trainieren oder öffnen",
    "Train on the database": "Mit der Datenbank trainieren",
    "Opening the model": "Das Modell wird geöffnet",
    "One phone": "Ein Telefon",
    "{first} to {last}": "{first} bis {last}",
    "The motion database has nothing like this take: add clips of such movements, calibrate the "
    "sensors, or check where they are worn": (
        "Die Bewegungsdatenbank enthält nichts Ähnliches: Clips solcher Bewegungen hinzufügen, die "
        "Sensoren kalibrieren oder prüfen, wo sie getragen werden"
    ),
    "Several movements of the motion database fit the sensors alike: more sensors, sensors with "
    "gyroscopes, or clips of this performer help": (
        "Mehrere Bewegungen der Datenbank passen gleich gut zu den Sensoren: mehr Sensoren, solche "
        "mit Gyroskopen oder Clips dieses Darstellers helfen"
    ),
    "Check the sensor at {site}: it fits far worse than the others": (
        "Den Sensor prüfen, {site}: er passt viel schlechter als die anderen"
    ),
    "Poor: {parts} s": "Schlecht: {parts} s",
    "Poor match: calibrate the sensors, check where they are worn, "
    "or add clips of such movements to the database": (
        "Schlechte Übereinstimmung: die Sensoren kalibrieren, prüfen, wo sie getragen werden, oder "
        "Clips solcher Bewegungen zur Datenbank hinzufügen"
    ),
    "Fair match: calibrating the sensors, or more clips of such movements, may help": (
        "Mittlere Übereinstimmung: Kalibrieren oder mehr Clips solcher Bewegungen können helfen"
    ),
    "Without a calibration, wear the sensors in the default orientation (see README)": (
        "Ohne Kalibrierung die Sensoren so tragen, wie es im README steht"
    ),
    "{site}: quality {quality}, {gravity} m/s² at rest": (
        "{site}: Qualität {quality}, {gravity} m/s² in Ruhe"
    ),
    "The recording continues even if Blender quits": (
        "Die Aufnahme geht weiter, auch wenn Blender endet"
    ),
    "Saved: {path}": "Gespeichert: {path}",
    "{count} poses": "{count} Posen",
    "{count} lost": "{count} verloren",
    "Battery {percent} %": "Akku {percent} %",
    "Battery {percent} %: charge it": "Akku {percent} %: bitte laden",
    "Shake: {site}": "Schütteln: {site}",
    "Choose a protocol: its options are listed here": (
        "Ein Protokoll wählen: hier stehen dann seine Optionen"
    ),
    "Choose a protocol first": "Zuerst ein Protokoll wählen",
    "Which sensor will be shaken?": "Welcher Sensor wird geschüttelt?",
    "Where is {sensor} worn?": "Wo wird {sensor} getragen?",
    "Bones of {name}": "Knochen von {name}",
    "{count} files": "{count} Dateien",
    "This is not the size of a person: check the unit": (
        "Das ist nicht die Größe eines Menschen: die Einheit prüfen"
    ),
    "Something is wrong? Paste this into a bug report:": (
        "Etwas stimmt nicht? Das gehört in eine Fehlermeldung:"
    ),
    "{job}: press Esc to cancel": "{job}: Esc bricht ab",
    "Recording starts in": "Die Aufnahme beginnt in",
    "measured {value}": "gemessen {value}",
    "expected {value} m/s²": "erwartet {value} m/s²",
    "Get ready, you will stand still with your arms hanging": (
        "Bereit machen, gleich stillstehen mit hängenden Armen"
    ),
    "Stand still, arms hanging, palms at the thighs": (
        "Stillstehen, Arme hängen, Handflächen an den Oberschenkeln"
    ),
    "Next: elbows, bend both five times, thumbs forward": (
        "Als Nächstes: Ellenbogen, beide fünfmal beugen, Daumen nach vorn"
    ),
    "Bend both elbows, five times, thumbs forward, upper arms still": (
        "Beide Ellenbogen beugen, fünfmal, Daumen nach vorn, Oberarme ruhig"
    ),
    "Next: squats, five times on the spot": "Als Nächstes: Kniebeugen, fünfmal auf der Stelle",
    "Squat, five times, heels on the ground": "Kniebeuge, fünfmal, Fersen am Boden",
    "Arms out to the sides, stand upright, palms down": (
        "Arme zur Seite, aufrecht stehen, Handflächen nach unten"
    ),
    "Arms forward, stand upright, palms down": (
        "Arme nach vorn, aufrecht stehen, Handflächen nach unten"
    ),
    "Arms straight up, stand upright, palms outward": (
        "Arme senkrecht nach oben, aufrecht stehen, Handflächen nach außen"
    ),
    "Elbows bent, upper arms at the sides, forearms level and forward": (
        "Ellenbogen gebeugt, Oberarme am Körper, Unterarme waagerecht nach vorn"
    ),
    "Bow by 45 degrees, back and knees straight, arms along the body": (
        "Um 45 Grad verbeugen, Rücken und Knie gerade, Arme am Körper"
    ),
    "Left knee up, thigh level, right arm forward, left arm out": (
        "Linkes Knie hoch, Oberschenkel waagerecht, rechter Arm nach vorn, linker zur Seite"
    ),
    "Right knee up, thigh level, left arm forward, right arm out": (
        "Rechtes Knie hoch, Oberschenkel waagerecht, linker Arm nach vorn, rechter zur Seite"
    ),
    "Lean to the left, at the waist, arms stretched out from the chest": (
        "Nach links neigen, in der Taille, Arme seitlich vom Brustkorb weg"
    ),
    "Get ready": "Bereit machen",
    "Hold still": "Stillhalten",
    "The last pose was {degrees} degrees off": "Die letzte Pose war {degrees} Grad daneben",
    "As in a mirror": "Wie im Spiegel",
    "Differs from A: {parts}": "Weicht von A ab: {parts}",
    "searching": "Ähnliche Bewegungen suchen",
    "fitting": "Posen einpassen",
    "smoothing": "Bewegung glätten",
    "finding how the sensor is worn": "Sitz des Sensors suchen",
    "placing the feet": "Füße aufsetzen",
    "From your right": "Von rechts gesehen",
}
