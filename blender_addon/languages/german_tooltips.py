# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender shows when the pointer rests on a button or a setting."""

TOOLTIPS = {
    # Motion database
    "Let a simulated performer (blue) do generated movements with four simulated sensors, and put "
    "what is reconstructed from these on a Rigify character (orange). "
    "No file and no sensor is needed": (
        "Ein simulierter Darsteller (blau) macht erzeugte Bewegungen mit vier simulierten "
        "Sensoren; was daraus rekonstruiert wird, kommt auf einen Rigify-Charakter (orange). "
        "Ganz ohne Datei und Sensor"
    ),
    "Make a motion database of generated movements: walk, jog, turn, kick, squat, jumping jack "
    "and others. It is there to try things out, not for finished animation": (
        "Eine Bewegungsdatenbank aus erzeugten Bewegungen: Gehen, Laufen, Drehen, Tritt, "
        "Kniebeuge, Hampelmann und andere. Zum Ausprobieren, nicht für fertige Animationen"
    ),
    "The motion database (.smdb) to reconstruct from": (
        "Die Bewegungsdatenbank (.smdb), aus der rekonstruiert wird"
    ),
    "Open a motion database (.smdb)": "Eine Bewegungsdatenbank (.smdb) öffnen",
    "Choose where to save the new motion database": (
        "Wählen, wo die neue Bewegungsdatenbank gespeichert wird"
    ),
    "Build another motion database": "Eine weitere Bewegungsdatenbank erstellen",
    "Build a motion database from all motion files in the folder": (
        "Aus allen Bewegungsdateien im Ordner eine Bewegungsdatenbank erstellen"
    ),
    "Build a motion database from every action of the scene's armatures. Import FBX, glTF or"
    " USD files first, then use this": (
        "Aus allen Actions der Armaturen der Szene eine Bewegungsdatenbank erstellen. Vorher FBX-, "
        "glTF- oder USD-Dateien importieren"
    ),
    "Add more folders or motion files to build the database from": (
        "Weitere Ordner oder Bewegungsdateien, aus denen die Datenbank erstellt wird"
    ),
    "Remove this folder or file from the list; it stays on disk": (
        "Diesen Ordner oder diese Datei aus der Liste entfernen; auf der Platte bleibt sie"
    ),
    "List all skipped files and warnings in the Text Editor, and copy them to the clipboard": (
        "Alle ausgelassenen Dateien und Warnungen im Texteditor auflisten und in die "
        "Zwischenablage kopieren"
    ),
    "Folder with motion files": "Ordner mit Bewegungsdateien",
    "Folder with motion files (.bvh, or .amc with .asf) and subfolders": (
        "Ordner mit Bewegungsdateien (.bvh, oder .amc mit .asf) und Unterordnern"
    ),
    "A folder of motion files, or a single file": (
        "Ein Ordner mit Bewegungsdateien oder eine einzelne Datei"
    ),
    "The .smdb file to write": "Die .smdb-Datei, die geschrieben wird",
    "The database file to write. Empty: next to the folder, with its name": (
        "Die Datenbankdatei, die geschrieben wird. Leer: neben dem Ordner, mit dessen Namen"
    ),
    "File names to exclude, separated by commas": "Dateinamen zum Auslassen, durch Kommas getrennt",
    "File names to exclude, separated by commas, for example: *_02.bvh, test*": (
        "Dateinamen zum Auslassen, durch Kommas getrennt, zum Beispiel: *_02.bvh, test*"
    ),
    "Also add a mirrored copy of every motion": "Jede Bewegung auch gespiegelt hinzufügen",
    "Also add a mirrored copy of every motion, for twice as many motions": (
        "Jede Bewegung auch gespiegelt hinzufügen, also doppelt so viele Bewegungen"
    ),
    "Also add a reversed copy of every motion": "Jede Bewegung auch rückwärts hinzufügen",
    "Also add slower (0.8x) and faster (1.25x) copies while the database is small": (
        "Auch langsamere (0,8x) und schnellere (1,25x) Kopien hinzufügen, solange die Datenbank "
        "klein ist"
    ),
    "Frames per second of the database; takes are reconstructed at this rate": (
        "Bilder pro Sekunde in der Datenbank; damit werden Aufnahmen rekonstruiert"
    ),
    "Build nothing if a file cannot be used. Off: the file is skipped and listed": (
        "Nichts erstellen, wenn eine Datei nicht brauchbar ist. Aus: sie wird ausgelassen und "
        "aufgelistet"
    ),
    # Clips
    "Play the clip in the viewport on a separate preview armature": (
        "Den Clip in der Ansicht auf einer eigenen Vorschau-Armatur abspielen"
    ),
    "Play only this clip in a loop. Sets the preview range, not the scene's frame range": (
        "Nur diesen Clip wiederholen. Setzt den Vorschaubereich, nicht den Bereich der Szene"
    ),
    "Keep this clip as an armature and action. The next preview uses a new armature": (
        "Diesen Clip als Armatur und Action behalten. Die nächste Vorschau nimmt eine neue Armatur"
    ),
    "Number in the list; -1: the selected clip": "Nummer in der Liste; -1: der ausgewählte Clip",
    "Find clips by words in their name, actor or class": (
        "Clips nach Wörtern in Name, Darsteller oder Art suchen"
    ),
    "Sort the list by": "Die Liste sortieren",
    "By actor, then by name": "Nach Darsteller, dann nach Name",
    "Also list the mirrored, reversed, faster and slower copies": (
        "Auch die gespiegelten, umgekehrten, schnelleren und langsameren Kopien auflisten"
    ),
    # Takes
    "Load a recorded take (.csv)": "Eine Aufnahme (.csv) laden",
    "List all takes in the folder of takes, and find missing ones there": (
        "Alle Aufnahmen im Ordner der Aufnahmen auflisten und fehlende dort suchen"
    ),
    "Remove the take from the list. Its file stays": (
        "Die Aufnahme aus der Liste entfernen. Ihre Datei bleibt"
    ),
    "The recorded take (.csv) to reconstruct": "Die Aufnahme (.csv), die rekonstruiert wird",
    "The take (.csv), relative to the .blend file": (
        "Die Aufnahme (.csv), relativ zur .blend-Datei"
    ),
    "How well its last reconstruction matched": (
        "Wie gut die letzte Rekonstruktion übereinstimmte"
    ),
    "Mark a good take": "Eine gute Aufnahme markieren",
    "In s": "In s",
    "Where takes are saved while the .blend file is not. Empty: Sparse Mocap in the home folder": (
        "Wo Aufnahmen gespeichert werden, solange die .blend-Datei es nicht ist. Leer: Sparse "
        "Mocap im Benutzerordner"
    ),
    # Reconstruct
    "Reconstruct the full-body motion of the take as an action on an armature": (
        "Die Bewegung des ganzen Körpers aus der Aufnahme rekonstruieren, als Action einer Armatur"
    ),
    "How motion is reconstructed": "Wie Bewegung rekonstruiert wird",
    "The settings of the method": "Die Einstellungen des Verfahrens",
    "The default settings": "Die üblichen Einstellungen",
    "NAME=VALUE, separated by commas": "NAME=WERT, durch Kommas getrennt",
    "Give an option of the method another value than its default": (
        "Einer Option des Verfahrens einen anderen Wert geben"
    ),
    "Use the default value of this option again": "Wieder den üblichen Wert dieser Option nehmen",
    "The value to use; press X for the default": "Der Wert; X stellt den üblichen wieder her",
    "Go to the frame where the next part with a poor match begins": (
        "Zum Bild gehen, bei dem der nächste Teil mit schlechter Übereinstimmung beginnt"
    ),
    "Use the whole take for every frame": "Für jedes Bild die ganze Aufnahme nutzen",
    "Use the whole take for every frame: more accurate and smoother, but slower. "
    "Off: the same as in a live preview": (
        "Für jedes Bild die ganze Aufnahme nutzen: genauer und glatter, aber langsamer. Aus: wie "
        "in der Live-Vorschau"
    ),
    "The scene frame on which the take starts": "Das Bild der Szene, mit dem die Aufnahme beginnt",
    "Put the action on a Sparse Mocap armature in this scene, not on a new one": (
        "Die Action auf eine Sparse-Mocap-Armatur dieser Szene legen, nicht auf eine neue"
    ),
    "The armature that live previews and takes move. Empty: a figure of the add-on's own": (
        "Die Armatur, die Live-Vorschau und Aufnahmen bewegen. Leer: eine eigene Figur des Add-ons"
    ),
    "Also put takes on the other selected armatures": (
        "Aufnahmen auch auf die anderen ausgewählten Armaturen legen"
    ),
    "Which controls of a rig that has both get the keys of arms and legs": (
        "Welche Steuerknochen die Keyframes von Armen und Beinen bekommen, wenn ein Rig beide hat"
    ),
    "Arms and legs by their FK controls": "Arme und Beine durch ihre FK-Knochen",
    "Legs by their IK controls, arms by their FK controls": (
        "Beine durch ihre IK-Knochen, Arme durch ihre FK-Knochen"
    ),
    "Arms and legs by their IK controls": "Arme und Beine durch ihre IK-Knochen",
    "The object at whose height the feet stand. Empty: the height of the character's origin": (
        "Das Objekt, auf dessen Höhe die Füße stehen. Leer: die Höhe des Ursprungs des Charakters"
    ),
    "How far feet stay where they stand: 0 as reconstructed, 1 without any sliding": (
        "Wie sehr Füße bleiben, wo sie stehen: 0 wie rekonstruiert, 1 ganz ohne Rutschen"
    ),
    "How certain a contact with the floor has to be for the foot to be locked": (
        "Wie sicher ein Fuß am Boden sein muss, damit er festgehalten wird"
    ),
    "Feet that move faster are not locked (m/s)": (
        "Füße, die sich schneller bewegen, werden nicht festgehalten (m/s)"
    ),
    "Feet that are higher above the floor are not locked (m)": (
        "Füße, die höher über dem Boden sind, werden nicht festgehalten (m)"
    ),
    "Keys on every whole frame of the scene. Off: keys at the take's own times, which "
    "usually lie between frames": (
        "Keyframes auf jedem ganzen Bild der Szene. Aus: zu den Zeiten der Aufnahme, die meist "
        "zwischen Bildern liegen"
    ),
    "Move the scene's end if the take would end after it": (
        "Das Ende der Szene verschieben, wenn die Aufnahme sonst danach endet"
    ),
    "Use only a part of the take, from one time to another": (
        "Nur einen Teil der Aufnahme nutzen, von einer Zeit bis zu einer anderen"
    ),
    "Where the part begins, in s from the take's beginning": (
        "Wo der Teil beginnt, in s vom Anfang der Aufnahme"
    ),
    "Where the part ends, in s from the take's beginning. 0: at its end": (
        "Wo der Teil endet, in s vom Anfang der Aufnahme. 0: an ihrem Ende"
    ),
    "Standard deviation of a Gaussian filter over the motion, in s. 0: none": (
        "Standardabweichung eines Gauß-Filters über die Bewegung, in s. 0: keiner"
    ),
    "Leave out keys while the motion stays within the errors below": (
        "Keyframes auslassen, solange die Bewegung innerhalb der Fehler darunter bleibt"
    ),
    "How far a bone's rotation may be off between keys, in degrees": (
        "Wie weit die Drehung eines Knochens zwischen Keyframes abweichen darf, in Grad"
    ),
    "How far a bone's location may be off between keys, in cm": (
        "Wie weit der Ort eines Knochens zwischen Keyframes abweichen darf, in cm"
    ),
    "Put the take on the active character again with the settings above, without "
    "reconstructing it: foot lock, limbs, part, smoothing, keys": (
        "Die Aufnahme mit den Einstellungen oben noch einmal auf den aktiven Charakter legen, ohne "
        "sie neu zu rekonstruieren: Füße, Arme und Beine, Ausschnitt, Glättung, Keyframes"
    ),
    "Put the active character's take into the NLA, as a strip on a new track": (
        "Die Aufnahme des aktiven Charakters als Strip auf einer neuen Spur in den NLA legen"
    ),
    "Play another action on a ghost of the active character, to compare them": (
        "Eine andere Action auf einem Geist des aktiven Charakters abspielen, zum Vergleichen"
    ),
    "Also find up to two other motions, B and C, that fit the sensors almost as well. Only in "
    "best quality; takes longer": (
        "Auch bis zu zwei andere Bewegungen suchen, B und C, die fast ebenso gut zu den Sensoren "
        "passen. Nur in bester Qualität; dauert länger"
    ),
    "Also find other motions that fit the sensors almost as well": (
        "Auch andere Bewegungen suchen, die fast ebenso gut zu den Sensoren passen"
    ),
    "Play this motion of the take on the active character: A is the best guess, B and C fit the "
    "sensors almost as well": (
        "Diese Bewegung der Aufnahme auf dem aktiven Charakter abspielen: A passt am besten, B und "
        "C passen fast ebenso gut zu den Sensoren"
    ),
    "The motions found by the last reconstruction of this take": (
        "Die Bewegungen, die die letzte Rekonstruktion dieser Aufnahme gefunden hat"
    ),
    "Remove the ghost of the active character": "Den Geist des aktiven Charakters entfernen",
    "Add a simple body to the active figure, for previews and test renders": (
        "Der aktiven Figur einen einfachen Körper geben, für Vorschau und Testbilder"
    ),
    "Show where the sensors are (blue; orange and small without data), which feet stand (green "
    "squares), and limbs that are typically more than 8 cm off (long orange dashes) or 15 cm "
    "(short pink dashes)": (
        "Zeigen, wo die Sensoren sind (blau; ohne Daten orange und klein), welche Füße stehen "
        "(grüne Quadrate), und Glieder, die meist mehr als 8 cm (lange orange Striche) oder "
        "15 cm daneben sind (kurze rosa Striche)"
    ),
    "Show around the current frame what each sensor measured (blue) and what it should read on "
    "the result (orange, dashed), in m/s² with gravity. Where they differ, the result is not "
    "what was performed": (
        "Um das aktuelle Bild zeigen, was jeder Sensor gemessen hat (blau) und was er am Ergebnis "
        "messen müsste (orange, gestrichelt), in m/s² mit Schwerkraft. Wo sie sich unterscheiden, "
        "ist das Ergebnis nicht das, was vorgeführt wurde"
    ),
    # Live sensors
    "The serial port of the sensors, or udp://HOST:PORT": (
        "Der serielle Anschluss der Sensoren, oder udp://HOST:PORT"
    ),
    "Which kind of sensors is connected": "Welche Art von Sensoren verbunden ist",
    "Speed of the serial port, in bits per second. 0 tries the usual ones": (
        "Tempo des seriellen Anschlusses, in Bit pro Sekunde. 0 probiert die üblichen"
    ),
    "Options of the protocol as name=value, separated by commas, for example: "
    "rate_hz=100, output=mtdata. `sparse-mocap drivers` lists them all": (
        "Optionen des Protokolls als name=wert, durch Kommas getrennt, zum Beispiel: rate_hz=100, "
        "output=mtdata. `sparse-mocap drivers` listet alle auf"
    ),
    "Where each sensor is worn, in the order of the sensors and separated by commas, "
    "for example: left_wrist, right_wrist. The table of the connected sensors is surer": (
        "Wo jeder Sensor getragen wird, in der Reihenfolge der Sensoren und durch Kommas getrennt, "
        "zum Beispiel: left_wrist, right_wrist. Die Tabelle der verbundenen Sensoren ist sicherer"
    ),
    "Refresh the list of ports and running captures": (
        "Die Liste der Anschlüsse und laufenden Aufnahmen neu laden"
    ),
    "Add a port, for sensors that have one each": (
        "Einen Anschluss hinzufügen, für Sensoren mit je einem eigenen"
    ),
    "Remove this port from the list": "Diesen Anschluss aus der Liste entfernen",
    "Connect to the sensors at this port": "Mit den Sensoren an diesem Anschluss verbinden",
    "Connect to these sensors again; they are still received in the background": (
        "Wieder mit diesen Sensoren verbinden; sie werden im Hintergrund weiter empfangen"
    ),
    "Disconnect. A recording continues in the background": (
        "Trennen. Eine Aufnahme geht im Hintergrund weiter"
    ),
    "Choose where this sensor is worn. It is remembered for this sensor, whatever its port": (
        "Wählen, wo dieser Sensor getragen wird. Das bleibt gemerkt, an jedem Anschluss"
    ),
    "Choose a body part, then shake the sensor that is worn there": (
        "Ein Körperteil wählen, dann den Sensor schütteln, der dort getragen wird"
    ),
    "Preview the motion live on an armature. No keys are set": (
        "Die Bewegung live auf einer Armatur zeigen. Es werden keine Keyframes gesetzt"
    ),
    "Stop the live preview; the character's own pose and action come back": (
        "Die Live-Vorschau beenden; Pose und Action des Charakters kommen zurück"
    ),
    "Move the live character to the origin": "Den Live-Charakter zum Ursprung setzen",
    "Turn the live character to the front, at the origin, when its heading has drifted": (
        "Den Live-Charakter am Ursprung nach vorn drehen, wenn sich seine Richtung verschoben hat"
    ),
    "Keep the live character at the origin while it moves": (
        "Den Live-Charakter am Ursprung halten, während er sich bewegt"
    ),
    "Record the sensors. The recording continues even if Blender quits": (
        "Die Sensoren aufnehmen. Die Aufnahme geht weiter, auch wenn Blender endet"
    ),
    "Record the sensors after the countdown, or stop the recording. "
    "The recording continues even if Blender quits": (
        "Die Sensoren nach dem Countdown aufnehmen, oder die Aufnahme beenden. Die Aufnahme geht "
        "weiter, auch wenn Blender endet"
    ),
    "Stop recording, save the take and reconstruct it as an action on an armature": (
        "Die Aufnahme beenden, speichern und als Action einer Armatur rekonstruieren"
    ),
    "Seconds before a recording starts, shown in large letters": (
        "Sekunden, bevor die Aufnahme beginnt, groß angezeigt"
    ),
    "Play the timeline and its sound while recording. "
    "The take then starts on the frame where the recording began": (
        "Beim Aufnehmen die Zeitleiste mit Ton abspielen. Die Aufnahme beginnt dann auf dem Bild, "
        "bei dem sie angefangen hat"
    ),
    # Calibration
    "Find how each sensor sits on the body. The viewport shows the performer what to do: stand "
    "still, bend the elbows, squat": (
        "Herausfinden, wie jeder Sensor am Körper sitzt. Die Ansicht zeigt dem Darsteller, was zu "
        "tun ist: stillstehen, Ellenbogen beugen, Kniebeugen"
    ),
    "Find how trackers that tell their orientation sit on the body. The viewport shows the "
    "performer eight poses to imitate, one after the other; face the same way in all": (
        "Herausfinden, wie Tracker mit Orientierung am Körper sitzen. Die Ansicht zeigt dem "
        "Darsteller nacheinander acht Posen zum Nachmachen; dabei immer in dieselbe Richtung sehen"
    ),
    "Calibration of the sensors (.json), made with Calibrate. Empty: the sensors are "
    "worn in the default orientation (see README)": (
        "Kalibrierung der Sensoren (.json), mit Kalibrieren gemacht. Leer: die Sensoren werden so "
        "getragen, wie es im README steht"
    ),
    "Body height of the performer, in metres": "Körpergröße des Darstellers, in Metern",
    # Mapping
    "Show which bones of the character are mapped, to check and correct them": (
        "Zeigen, welche Knochen des Charakters zugeordnet sind, zum Prüfen und Ändern"
    ),
    "Use the active bone for this part of the body": (
        "Den aktiven Knochen für dieses Körperteil nehmen"
    ),
    "Use this mapping for every character and file with this skeleton from now on": (
        "Diese Zuordnung ab jetzt für alle Charaktere und Dateien mit diesem Skelett nehmen"
    ),
    "Forget this skeleton's mapping and detect its joints automatically again": (
        "Die Zuordnung dieses Skeletts vergessen und seine Gelenke wieder selbst erkennen"
    ),
    "Save this mapping to a .json file": "Diese Zuordnung in einer .json-Datei speichern",
    "Load a mapping from a .json file": "Eine Zuordnung aus einer .json-Datei laden",
    "The bone that is mapped. Empty: detected automatically": (
        "Der zugeordnete Knochen. Leer: wird erkannt"
    ),
    # Import
    "Import .bvh motion capture, each file on an armature with the file's skeleton": (
        "Motion Capture aus .bvh importieren, jede Datei auf einer Armatur mit ihrem Skelett"
    ),
    "Import .amc motion capture with the .asf skeleton from the same folder, or an .asf alone": (
        "Motion Capture aus .amc importieren, mit dem .asf-Skelett aus demselben Ordner, oder eine "
        ".asf allein"
    ),
    "Length unit of the file": "Längeneinheit der Datei",
    "The axis that points up in the file": "Die Achse, die in der Datei nach oben zeigt",
    "The scene frame on which the motion starts": (
        "Das Bild der Szene, mit dem die Bewegung beginnt"
    ),
    "Place the keys at the file's times, whatever the scene's frame rate. Off: one scene frame "
    "for each frame of the file, which may play faster or slower": (
        "Die Keyframes zu den Zeiten der Datei setzen, bei jeder Bildrate der Szene. Aus: ein Bild "
        "der Szene für jedes der Datei, was schneller oder langsamer abläuft"
    ),
    "Transfer the motion to the 21-joint skeleton that motion databases use": (
        "Die Bewegung auf das Skelett mit 21 Gelenken übertragen, das Bewegungsdatenbanken nutzen"
    ),
    "Frames per second of the .amc, which the file does not store": (
        "Bilder pro Sekunde der .amc, die in der Datei nicht stehen"
    ),
    "The unit stored in an .asf; centimetres for .bvh, which stores none": (
        "Die Einheit, die in der .asf steht; Zentimeter für .bvh, wo keine steht"
    ),
    "100 units are one metre": "100 Einheiten sind ein Meter",
    "1 unit is one metre": "1 Einheit ist ein Meter",
    "10 units are one metre, as in MakeHuman": "10 Einheiten sind ein Meter, wie in MakeHuman",
    "1000 units are one metre": "1000 Einheiten sind ein Meter",
    "1 unit is 2.54 cm": "1 Einheit sind 2,54 cm",
    "1 unit is 5.64 cm, as in the CMU and HDM05 databases": (
        "1 Einheit sind 5,64 cm, wie in den Datenbanken CMU und HDM05"
    ),
    "Y points up, as in most motion files": "Y zeigt nach oben, wie in den meisten Dateien",
    "Z points up, as in Blender": "Z zeigt nach oben, wie in Blender",
    "X points up": "X zeigt nach oben",
    # Help
    "Cancel and discard": "Abbrechen und verwerfen",
    "Copy versions, folders, settings and the newest lines of the log to the clipboard, for a "
    "bug report. Names of people are left out": (
        "Versionen, Ordner, Einstellungen und die letzten Zeilen des Protokolls in die "
        "Zwischenablage kopieren, für eine Fehlermeldung. Namen von Menschen fehlen darin"
    ),
}
