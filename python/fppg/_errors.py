"""What fppg raises. The texts are those of the program."""

import re


class Error(Exception):
    """Any error of fppg."""


class UsageError(Error, ValueError):
    """A wrong argument."""


class CaseError(Error):
    """The case definition is wrong, or not supported.

    file  the XML, or "" where the text names none
    line  in it, from 1; 0 where the text names none
    """

    def __init__(self, text: str) -> None:
        super().__init__(text)
        match = re.match(r"(.+?):(\d+): ", text)
        self.file: str = match[1] if match else ""
        self.line: int = int(match[2]) if match else 0


class GeometryError(Error):
    """A mesh cannot be used for what is asked of it."""


class IoError(Error, OSError):
    """A file cannot be read or written."""
