"""What a program with the address sanitizer cannot be asked."""


def is_sanitized(program):
    """It maps terabytes, so it lives under no limit of memory."""
    try:
        with open(program, "rb") as file:
            return b"__asan_init" in file.read()
    except OSError:
        return False


def times_slower(program):
    """Than one without, at most."""
    return 10 if is_sanitized(program) else 1
