# SPDX-License-Identifier: GPL-3.0-or-later
"""Teaching the motion database: labels, tooltips and reports."""

TEACHING = {
    "Teach": "Anlernen",
    "Teaching the motion database": "Die Bewegungsdatenbank wird angelernt",
    "Motion": "Bewegung",
    "Choose Motion": "Bewegung wählen",
    "Choose Take": "Aufnahme wählen",
    "Align by a clap": "Klatschen als Marke",
    "Taught": "Angelernt",
    "Begins at": "Beginnt bei",
    "very good": "sehr gut",
    "Choose a motion, and the take that your sensors recorded during it": (
        "Eine Bewegung wählen und die Aufnahme, die die Sensoren dabei gemacht haben"
    ),
    "Add a movement of yours together with what your sensors measured during it, so that "
    "later takes of such movements come out better": (
        "Eine eigene Bewegung zusammen mit dem hinzufügen, was die Sensoren dabei gemessen haben, "
        "damit spätere Aufnahmen solcher Bewegungen besser gelingen"
    ),
    "The motion file (.bvh, .amc, .npz, .mvnx) of the performance, for example from video": (
        "Die Bewegungsdatei (.bvh, .amc, .npz, .mvnx) der Aufführung, zum Beispiel aus einem Video"
    ),
    "The take (.csv) that the sensors recorded during the performance": (
        "Die Aufnahme (.csv), die die Sensoren während der Aufführung gemacht haben"
    ),
    "Motion and take have a clap or jump in common: align them by it. "
    "Off: they are aligned by comparing all readings": (
        "Bewegung und Aufnahme haben ein Klatschen oder einen Sprung gemeinsam: daran ausrichten. "
        "Aus: durch Vergleichen aller Messwerte ausrichten"
    ),
    "When the clap starts, in seconds from the start of the take": (
        "Wann das Klatschen beginnt, in Sekunden der Aufnahme"
    ),
    "When the clap ends, in seconds from the start of the take": (
        "Wann das Klatschen vorbei ist, in Sekunden der Aufnahme"
    ),
    "Choose the motion file of the performance": "Die Bewegungsdatei der Aufführung wählen",
    "Choose the take (.csv) that was recorded during the performance": (
        "Die Aufnahme (.csv) wählen, die während der Aufführung gemacht wurde"
    ),
    "Write a new motion database that also has this motion and what the sensors measured "
    "during it, and use it. The one in use stays as it is": (
        "Eine neue Bewegungsdatenbank schreiben, die auch diese Bewegung enthält und was die "
        "Sensoren dabei gemessen haben, und sie benutzen. Die bisherige bleibt, wie sie ist"
    ),
    "Agreement": "Passt",
    'Taught "{name}": the agreement of motion and take is {agreement}': (
        "„{name}“ angelernt; Übereinstimmung von Bewegung und Aufnahme: {agreement}"
    ),
    "Choose the motion file that was performed first": (
        "Zuerst die Bewegungsdatei der Aufführung wählen"
    ),
    "Choose the take (.csv) that was recorded with it first": (
        "Zuerst die Aufnahme (.csv) wählen, die dabei gemacht wurde"
    ),
    "The clap must end after it begins: change its times": (
        "Das Klatschen muss nach seinem Beginn enden: die Zeiten ändern"
    ),
    "{path} does not exist: choose another file": "{path} gibt es nicht: eine andere Datei wählen",
    "{name} is not a {endings} file": "{name} ist keine Datei der Art {endings}",
}
