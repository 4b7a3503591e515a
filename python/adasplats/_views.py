# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The type of the arrays that look into the library's memory."""
import numpy as np

# NumPy tells consumers that an array is read-only from this version on (DLPack 1.0).
_NUMPY_TELLS = tuple(int(part) for part in np.__version__.split(".")[:2]) >= (2, 1)


class ArrayView(np.ndarray):
    """A read-only NumPy array over memory of adasplats, which it keeps alive.

    It is exported through DLPack, too, which NumPy itself refuses for read-only arrays before 2.1: a
    consumer that understands DLPack 1.0 is told that it may not write; any other one gets a copy, or
    BufferError where it forbids copies. What is computed of it is a plain array.
    """

    def __dlpack__(self, **wanted):
        version = wanted.get("max_version")
        is_told = _NUMPY_TELLS and version is not None and version[0] >= 1
        if self.flags.writeable or is_told:
            return super().__dlpack__(**wanted)
        if wanted.pop("copy", None) is False:
            raise BufferError("a read-only array of adasplats cannot be handed to a library that "
                              "does not know DLPack 1.0's read-only flag: hand over array.copy()")
        wanted.pop("max_version", None)
        return np.array(self).__dlpack__(**wanted)

    def __array_wrap__(self, array, context=None, return_scalar=False):
        plain = np.asarray(array)
        return plain[()] if plain.ndim == 0 else plain

    def __reduce__(self):
        return self.view(np.ndarray).__reduce__()

    def __reduce_ex__(self, protocol):
        return self.view(np.ndarray).__reduce_ex__(protocol)
