"""Numbers in sentences: as many digits as matter, whatever the scale. The same rules as protocol/files/digits.hpp."""
import math


def _fixed(value, decimals):
    text = f"{value:.{decimals}f}"
    return text.lstrip("-") if not text.strip("-0.") else text


def _decimals(value, count):
    return min(max(count - 1 - math.floor(math.log10(abs(value))), 0), 6)


def _plain(value):
    return 1e-4 <= abs(value) < 1e7


def digits(value):
    """Three significant digits, and all of those before the point."""
    if abs(value) < 1e-12:
        return "0"
    return _fixed(value, _decimals(value, 3)) if _plain(value) else f"{value:.3g}"


def with_error(value, error):
    """'1398 ± 40', '2.53 ± 0.41': the error with two significant digits, the value down to the same place."""
    if error is None or not math.isfinite(error):
        return f"{digits(value)} ± unknown"
    if not _plain(error) or abs(value) >= 1e7:
        return f"{digits(value)} ± {digits(error)}"
    decimals = _decimals(error, 2)
    return f"{_fixed(value, decimals)} ± {_fixed(error, decimals)}"
