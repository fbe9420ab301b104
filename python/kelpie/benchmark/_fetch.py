# SPDX-License-Identifier: Apache-2.0
"""Fetches the public data sets into a folder, each file checked by its SHA-256."""

from __future__ import annotations

import shutil
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Optional

from ._manifest import ManifestError, checksum, read_manifest
from ._origins import ORIGINS, Origin

PUBLIC = Path(__file__).with_name("public.toml")
_MOST_BYTES = 50_000_000  # of a file from the web


class NotFetched(ManifestError):
    """A file that is neither at the place given nor made of its origin's file."""


def fetch(folder: Path, place: Optional[str] = None) -> Iterator[tuple[str, bool]]:
    """Copies every file of public.toml, and public.toml, into `folder`.

    Yields a line per data set, and whether its files are there now. `place` is a folder, whose
    subfolders are searched too, or an address that begins with http:// or https:// and has the
    files below it. A file that is not there is made of its origin's file (ORIGINS), from `place` or the
    origin's address. ManifestError where a file has another checksum; a file in `folder` with the
    right checksum is left alone.
    """
    if place is not None and not _is_web(place) and not Path(place).is_dir():
        raise ManifestError(f"--from {place}: is no folder; a folder with the files, or an address "
                            "that begins with https://, is wanted")
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(PUBLIC, folder / PUBLIC.name)
    for source in read_manifest(PUBLIC):
        try:
            for path, wanted in zip(source.paths(), source.sha256):
                _take(folder / path.name, wanted, place)
        except NotFetched as error:
            yield f"{source.name}: {error} ({source.origin}, {source.license})", False
        else:
            yield (f"{source.name}: {len(source.files)} file(s), checked; licence "
                   f"{source.license}; from {source.origin}", True)


def _is_web(place: str) -> bool:
    return place.startswith(("http://", "https://"))


def _take(target: Path, wanted: str, place: Optional[str]) -> None:
    if target.is_file() and checksum(target) == wanted:
        return
    draft = target.with_name(f".{target.name}.draft")
    try:
        if not _copied(place, target.name, draft):
            origin = ORIGINS.get(target.name)
            if origin is None:
                raise NotFetched(f"no {target.name}, which is a converted file: give --from with "
                                 "copies")
            _convert(origin, place, draft)
        _check(draft, wanted, target.name)
        draft.replace(target)
    finally:
        draft.unlink(missing_ok=True)


def _check(file: Path, wanted: str, name: str) -> None:
    if checksum(file) != wanted:
        raise ManifestError(f"{name}: has SHA-256 {checksum(file)}; wanted is {wanted}")


def _convert(origin: Origin, place: Optional[str], draft: Path) -> None:
    if not _copied(place, origin.name, draft):
        _download(origin.address, draft)
    _check(draft, origin.sha256, origin.name)
    draft.write_text(origin.convert(draft), encoding="utf-8")


def _copied(place: Optional[str], name: str, draft: Path) -> bool:
    """Whether the file of the name was at the place."""
    if place is None:
        return False
    if _is_web(place):
        try:
            _download(f"{place.rstrip('/')}/{name}", draft)
        except NotFetched:
            return False
        return True
    found = next(iter(sorted(Path(place).rglob(name))), None)
    if found is not None:
        shutil.copyfile(found, draft)
    return found is not None


def _download(address: str, target: Path) -> None:
    try:
        with urllib.request.urlopen(address, timeout=60) as answer:
            content = answer.read(_MOST_BYTES + 1)
    except (urllib.error.URLError, OSError) as error:
        raise NotFetched(f"{address}: {getattr(error, 'reason', error)}") from None
    if len(content) > _MOST_BYTES:
        raise ManifestError(f"{address}: has more than {_MOST_BYTES} bytes")
    target.write_bytes(content)
