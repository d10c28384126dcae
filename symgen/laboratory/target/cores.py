"""The processor cores symgen measures on: how to compile for them, and the emulated board that runs the result."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from symgen.ir.kernel import Scalar

Family: TypeAlias = Literal["arm", "riscv"]
Compiler: TypeAlias = Literal["gcc", "clang"]


@dataclass(frozen=True, slots=True)
class Region:
    """A range of addresses, as a linker script writes it."""

    origin: str
    length: str


@dataclass(frozen=True, slots=True)
class Core:
    """One core: compiler flags, QEMU's arguments and memory; `native` are the scalar types its FPU computes with."""

    name: str
    family: Family
    gcc: tuple[str, ...]
    clang: tuple[str, ...]
    machine: tuple[str, ...]
    code: Region
    data: Region
    native: tuple[Scalar, ...]
    note: str = ""


def _arm(
    name: str, cpu: str, abi: tuple[str, ...], triple: str, machine: tuple[str, ...], native: tuple[Scalar, ...],
    code: str = "0x00000000", data: str = "0x20000000", note: str = "",
) -> Core:
    flags = (f"-mcpu={cpu}", "-mthumb", *abi)
    return Core(
        name, "arm", flags, (f"--target={triple}", *flags), ("-M", *machine), Region(code, "4M"), Region(data, "2M"),
        native, note,
    )


# gcc splits pairs of words early otherwise: float64 kernels get 2 to 5 % longer and take twice the time to compile.
_WHOLE = "-fno-split-wide-types"


def _riscv(name: str, architecture: str, abi: str, native: tuple[Scalar, ...]) -> Core:
    flags = (f"-march={architecture}", f"-mabi={abi}", "-mcmodel=medany")
    return Core(
        name, "riscv", (*flags, _WHOLE), ("--target=riscv32-unknown-elf", *flags), ("-M", "virt", "-bios", "none"),
        Region("0x80000000", "16M"), Region("0x81000000", "16M"), native, note=f"gcc with {_WHOLE}",
    )


_HARD = "-mfloat-abi=hard"
# QEMU has no Cortex-M0+: its code runs on the M0 of a micro:bit, which is given the memory that all kernels need.
_ROOM = ("microbit", "-global", "nrf51-soc.flash-size=4194304", "-global", "nrf51-soc.sram-size=2097152")
_M0 = "runs on an emulated Cortex-M0, which has the same instructions"

CORES: tuple[Core, ...] = (
    _arm("cortex-m0+", "cortex-m0plus", ("-mfloat-abi=soft",), "thumbv6m-none-eabi", _ROOM, (), note=_M0),
    _arm(
        "cortex-m4f", "cortex-m4", (_HARD, "-mfpu=fpv4-sp-d16"), "thumbv7em-none-eabihf", ("mps2-an386",), ("float32",)
    ),
    _arm(
        "cortex-m7", "cortex-m7", (_HARD, "-mfpu=fpv5-d16"), "thumbv7em-none-eabihf", ("mps2-an500",),
        ("float64", "float32"),
    ),
    _arm(
        "cortex-m33", "cortex-m33", (_HARD, "-mfpu=fpv5-sp-d16"), "thumbv8m.main-none-eabihf", ("mps2-an505",),
        ("float32",), code="0x10000000", data="0x38000000",
    ),
    _riscv("rv32imac", "rv32imac", "ilp32", ()),
    _riscv("rv32imafc", "rv32imafc", "ilp32f", ("float32",)),
)
BY_NAME: dict[str, Core] = {core.name: core for core in CORES}
LEVELS: tuple[str, ...] = ("-O0", "-O1", "-O2", "-O3", "-Os")
