"""Numbers packed for the page: deflated, in base64. The browser unpacks them (source/data.js)."""
import base64
import zlib

import numpy as np

MOST_POINTS = 3000  # of a curve


def shuffled(values):
    """The bytes of `values` by significance: all lowest bytes first, all highest last. They deflate much better so."""
    flat = np.ascontiguousarray(values).ravel()
    return flat.view(np.uint8).reshape(flat.size, flat.itemsize).T.tobytes()


class Stream:
    """One deflated stream, made piece by piece, so that its size is known on the way."""

    def __init__(self):
        self._deflate = zlib.compressobj(7)
        self._parts = []
        self.size = 0  # bytes, deflated

    def add(self, data):
        self._keep(self._deflate.compress(data))

    def mark(self):
        """From here on `size` counts all that was added."""
        self._keep(self._deflate.flush(zlib.Z_SYNC_FLUSH))

    def base64(self):
        self._keep(self._deflate.flush())
        return base64.b64encode(b"".join(self._parts)).decode()

    def _keep(self, part):
        if part:
            self._parts.append(part)
            self.size += len(part)


class Arrays:
    """Curves and fields of a page as 32-bit numbers; blocks refer to them by their number."""

    def __init__(self):
        self.places = []  # (first number, how many)
        self._stream = Stream()
        self._length = 0
        self._known = {}

    def add(self, values, exact=False):
        """The number of the array. Unless `exact`, 15 bits of each value's fraction are kept: 3e-5 of it."""
        with np.errstate(over="ignore", invalid="ignore"):
            numbers = np.asarray(values, float).astype("<f4")
        numbers[~np.isfinite(numbers)] = np.nan
        if not exact:
            numbers = (numbers.view("<u4") & np.uint32(0xFFFFFF00)).view("<f4")
        data = shuffled(numbers)
        key = (len(data), zlib.crc32(data), zlib.adler32(data))
        if key not in self._known:
            self._known[key] = len(self.places)
            self.places.append((self._length, int(numbers.size)))
            self._stream.add(data)
            self._length += numbers.size
        return self._known[key]

    @property
    def size(self):
        """Bytes, deflated, as far as they are known."""
        return self._stream.size + 0x10000

    def base64(self):
        return self._stream.base64()


def thin(time, columns):
    """(time, columns, samples per bucket) with at most MOST_POINTS points: of each bucket the lowest and the highest
    value of every column, in their order."""
    count = len(time)
    if count <= MOST_POINTS:
        return time, columns, 1
    bucket = -(-2 * count // MOST_POINTS)
    whole = count // bucket * bucket
    rows = time[:whole].reshape(-1, bucket)
    thinned = {}
    for name, values in columns.items():
        block = values[:whole].reshape(-1, bucket)
        finite = np.nan_to_num(block)
        low, high = finite.argmin(1), finite.argmax(1)
        pair = np.sort(np.stack([low, high], 1), 1)
        thinned[name] = np.take_along_axis(block, pair, 1).ravel()
    return np.stack([rows[:, 0], rows[:, bucket // 2]], 1).ravel(), thinned, bucket
