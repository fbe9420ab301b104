# SPDX-License-Identifier: Apache-2.0
"""12: a host in Python of a model that kelpie renews (docs/howto/controller.md).

    kelpie export out/live/model.json --live vehicle.so
    kelpie live --config mission.toml --block vehicle.block &
    python3 examples/12_live_host.py ./vehicle.so 60

Where CasADi is installed, `casadi.external("kelpie_model", "./vehicle.so")` makes a function of the
same library for an optimal-control problem. This program needs nothing but Python: ctypes calls the
functions by CasADi's convention, a hundred times a second.
"""

import ctypes
import random
import sys
import time

Double = ctypes.c_double
Pointer = ctypes.POINTER(Double)


class LiveModel:
    """The functions of a library of `kelpie export --live`."""

    def __init__(self, path: str, name: str = "kelpie_model") -> None:
        self._library = ctypes.CDLL(path)
        self._name = name
        self.inputs = self._rows("sparsity_in")
        self.targets = self._rows("sparsity_out")
        self._library[name + "_renew"].restype = ctypes.c_ulonglong
        self._library[name + "_problem"].restype = ctypes.c_char_p

    def _rows(self, function: str) -> int:
        sparsity = self._library[f"{self._name}_{function}"]
        sparsity.restype = ctypes.POINTER(ctypes.c_longlong)
        return sparsity(ctypes.c_longlong(0))[0]

    def renew(self) -> int:
        """The number of the publication in use, 0 without a model."""
        return self._library[self._name + "_renew"]()

    def bounds(self) -> list[tuple[float, float]]:
        """The range of every input among the samples that the learner knows."""
        low, high = (Double * self.inputs)(), (Double * self.inputs)()
        self._library[self._name + "_bounds"](low, high)
        return list(zip(low, high))

    def _call(self, name: str, x: list[float], size: int) -> list[float]:
        result = (Double * size)()
        arguments = (Pointer * 2)((Double * self.inputs)(*x))
        results = (Pointer * 1)(result)
        if self._library[name](arguments, results, None, None, 0) != 0:
            raise RuntimeError(self._library[self._name + "_problem"]().decode())
        return list(result)

    def predict(self, x: list[float]) -> list[float]:
        return self._call(self._name, x, self.targets)

    def jacobian(self, x: list[float]) -> list[list[float]]:
        """A row per target."""
        columns = self._call("jac_" + self._name, x, self.targets * self.inputs)
        return [columns[i :: self.targets] for i in range(self.targets)]

    def hessian_vector(self, x: list[float], v: list[float], weights: list[float]) -> list[float]:
        """The second derivatives of all targets, summed with these weights, times v."""
        product = (Double * self.inputs)()
        self._library[self._name + "_hessian_vector"](
            (Double * len(x))(*x), (Double * len(v))(*v), (Double * len(weights))(*weights), product
        )
        return list(product)


def main(path: str, seconds: float) -> None:
    model = LiveModel(path)
    took_us, numbers = [], set()
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        x = [random.uniform(low, high) for low, high in model.bounds()]
        time.sleep(0.01)
        begin = time.perf_counter()
        model.jacobian(x)
        took_us.append(1e6 * (time.perf_counter() - begin))
        model.predict(x)
        model.hessian_vector(x, [1.0] * model.inputs, [1.0] * model.targets)
        numbers.add(model.renew())
    took_us.sort()
    median, late = took_us[len(took_us) // 2], took_us[len(took_us) * 99 // 100]
    print(
        f"calls {len(took_us)}, publications {len(numbers)}, "
        f"median {median:.1f} us, 99 % {late:.1f} us"
    )


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 10.0)
