# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap ports``: the serial ports of this machine."""

from __future__ import annotations

import json

import click
from rich.table import Table

from ..capture.ports import PortInfo, available_ports
from .console import print_table

__all__ = ["ports"]


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print as JSON.")
def ports(as_json: bool) -> None:
    """Lists the serial ports and their devices."""
    found = available_ports()
    if as_json:
        click.echo(json.dumps([port.as_json() for port in found], indent=2, ensure_ascii=False))
        return
    if not found:
        click.echo(
            "No serial ports found: plug a device in, or use a pyserial URL (socket://HOST:PORT)."
        )
        return
    table = Table("port", "device", "vendor:product", "serial number", box=None)
    for port in found:
        table.add_row(port.port, _device(port), _numbers(port), port.serial_number or "")
    print_table(table)


def _device(port: PortInfo) -> str:
    names = (port.manufacturer, port.product)
    return " ".join(name for name in names if name) or port.description


def _numbers(port: PortInfo) -> str:
    if port.vendor_id is None:
        return ""
    return f"{port.vendor_id:04x}:{port.product_id or 0:04x}"
