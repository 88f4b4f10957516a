# SPDX-License-Identifier: GPL-3.0-or-later
"""What the package sparse_mocap and the system say about ports, sensors and files."""

from __future__ import annotations

CORE = {
    # Ports
    "{port}: permission denied; add yourself to the port's group "
    "(sudo usermod -a -G dialout $USER), then log out and in": (
        "{port}: Zugriff verweigert; sich selbst in die Gruppe des Ports aufnehmen "
        "(sudo usermod -a -G dialout $USER), dann ab- und wieder anmelden"
    ),
    "{port}: access denied; close other programs that use the port": (
        "{port}: Zugriff verweigert; andere Programme schließen, die den Port benutzen"
    ),
    "{port}: no such port; plug the device in (`sparse-mocap ports` lists all ports)": (
        "{port}: diesen Port gibt es nicht; das Gerät einstecken"
    ),
    "{port}: in use by another program; close that program": (
        "{port}: von einem anderen Programm benutzt; dieses schließen"
    ),
    "{port}: not a serial port; `sparse-mocap ports` lists them": (
        "{port}: kein serieller Port; einen anderen wählen"
    ),
    "{port}: connection refused; start the server for this port": (
        "{port}: Verbindung abgelehnt; den Server für diesen Port starten"
    ),
    "{port}: another device is plugged in there; plug {identity} in again": (
        "{port}: dort steckt ein anderes Gerät; {identity} wieder einstecken"
    ),
    # Sensors
    "nothing has arrived; check that the device is on, and its cable and baud rate": (
        "es kommt nichts an; prüfen, ob das Gerät eingeschaltet ist, dazu Kabel und Baudrate"
    ),
    "nothing has arrived; check that the device is on": (
        "es kommt nichts an; prüfen, ob das Gerät eingeschaltet ist"
    ),
    "nothing has arrived; give the sensors this computer's address and the port's number, "
    "and let them through the firewall": (
        "es kommt nichts an; den Sensoren die Adresse dieses Rechners und die Nummer des Ports "
        "geben und sie durch die Firewall lassen"
    ),
    "these look like {messages}; choose the protocol {driver} instead of {chosen}": (
        "das sieht aus wie {messages}; das Protokoll {driver} statt {chosen} wählen"
    ),
    "the data, such as {data}, are not of the protocol {driver}; check the protocol and the baud "
    "rate ({baud}); 0 tries the usual rates": (
        "die Daten, etwa {data}, gehören nicht zum Protokoll {driver}; Protokoll und Baudrate "
        "({baud}) prüfen; 0 probiert die üblichen"
    ),
    "the data, such as {data}, are not of the protocol {driver}; check the protocol": (
        "die Daten, etwa {data}, gehören nicht zum Protokoll {driver}; das Protokoll prüfen"
    ),
    "text arrives, such as '{line}', and not the data of the protocol {driver}; "
    "choose text_line, if these are numbers": (
        "es kommt Text an, etwa „{line}“, und nicht die Daten des Protokolls {driver}; sind es "
        "Zahlen, text_line wählen"
    ),
    "datagrams arrive, but no tracker has introduced itself yet; wait 5 s, "
    "then restart the tracker": (
        "Datagramme kommen an, aber noch hat sich kein Tracker gemeldet; 5 s warten, dann den "
        "Tracker neu starten"
    ),
    "{sensors} are both worn at {site}; choose another location for one": (
        "{sensors} sind beide hier: {site}; für einen davon eine andere Stelle wählen"
    ),
    "{folder}: no samples were recorded; check ports and drivers": (
        "{folder}: es wurden keine Messwerte aufgenommen; Ports und Protokolle prüfen"
    ),
    # Calibration
    "{site}: it is not still while the performer stands: its readings vary by {force} m/s^2; "
    "stand still for 2 s": (
        "{site}: der Sensor ist nicht ruhig, während der Darsteller steht: seine Messwerte "
        "schwanken um {force} m/s²; 2 s lang still stehen"
    ),
    "{site}: the standing pose lasts {seconds} s; stand still for 2 s or longer": (
        "{site}: die Standpose dauert {seconds} s; mindestens 2 s lang still stehen"
    ),
    "{site} moved by {distance} cm during {pose}; hold the pose still": (
        "{site} hat sich bei {pose} um {distance} cm bewegt; die Pose still halten"
    ),
    "{site} turned by {angle} degrees during {pose}; hold the pose still": (
        "{site} hat sich bei {pose} um {angle} Grad gedreht; die Pose still halten"
    ),
    "no bone was measured: lengths are those usual for people": (
        "kein Knochen wurde gemessen: die Längen sind die üblichen"
    ),
    "{device} was calibrated at {site} and is worn at {other} now: move it back, "
    "or calibrate again": (
        "{device} wurde hier kalibriert: {site}, und ist jetzt hier: {other}; zurücksetzen oder "
        "neu kalibrieren"
    ),
    "the calibration has no sensor {site}; it has {known}: calibrate again": (
        "in der Kalibrierung gibt es keinen Sensor {site}, nur {known}: neu kalibrieren"
    ),
    '{path}: is not a calibration file; it must be an object with "format": "{format}"': (
        "{path}: ist keine Kalibrierung; „format“ muss „{format}“ sein"
    ),
    "{site}: the recordings overlap by too little; record the event well inside both": (
        "{site}: Bewegung und Aufnahme überlappen sich zu wenig; das Klatschen weiter in die Mitte "
        "beider legen"
    ),
    # Files
    "{path}: no such file or folder; check the path": (
        "{path}: diese Datei oder diesen Ordner gibt es nicht; den Pfad prüfen"
    ),
    "{path}: is no motion file ({endings}); name motion files or folders": (
        "{path}: ist keine Bewegungsdatei ({endings}); Bewegungsdateien oder Ordner wählen"
    ),
    "{path}: not a sound {kind}: {problem}; build it again with 'sparse-mocap database build'": (
        "{path}: keine unversehrte {kind}: {problem}; sie neu erstellen"
    ),
    "{place}: no samples follow the header; record the take again": (
        "{place}: nach der Kopfzeile folgen keine Messwerte; die Aufnahme wiederholen"
    ),
    "{place}: {column} is {value}, which is not a number": (
        "{place}: {column} ist {value} und keine Zahl"
    ),
    "{path}: No such file or directory": "{path}: diese Datei oder diesen Ordner gibt es nicht",
    "{path}: Permission denied": "{path}: Zugriff verweigert",
    "{path}: No space left on device": "{path}: der Datenträger ist voll",
    "{path}: File too large": "{path}: die Datei würde zu groß",
    "{path}: Is a directory": "{path}: ist ein Ordner",
}
