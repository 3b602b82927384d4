"""Files that are no profiles, made of one that is: each with a word of the refusal.

Every case is a small change of a good profile that a careless program reads as another
number, never ends with, or runs as a program.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

YAML = """\
format: des-coriolis/1
name: small
machine: des
initial: {arm_deg: 0}
time: {start_s: 0, stop_s: 1, step_s: 0.05}
joints:
  arm_rpm: "8.8 - 0.66*t"
  fork_deg: "-60*(1 - cos(pi*t/5))"
  cab_deg: "30 - 2.5*t"
reduction: {axes: report, control: scalar, r1: [0, 2, 0], r2: 1, limits: warn}
"""

ROWS = [f"{0.1 * k:.1f},{8.8 - 0.01 * k:.2f},{-0.5 * k:.1f},{30 - k:.1f}" for k in range(8)]
HEADER = "t_s,arm_rpm,fork_deg,cab_deg"


class Case(NamedTuple):
    """A file, and how it is refused."""

    name: str
    data: bytes
    word: str


def csv_of(rows: list[str], header: str = HEADER) -> str:
    return "\n".join([header, *rows]) + "\n"


def cases() -> Iterator[Case]:
    """Make every case; all of them are refused with 3."""
    for number, (text, word) in enumerate(_yaml()):
        yield Case(f"y{number:03d}.yaml", text.encode(), word)
    for number, (text, word) in enumerate(_csv()):
        yield Case(f"c{number:03d}.csv", text.encode(), word)
    for number, (data, word) in enumerate(_bytes()):
        yield Case(f"b{number:03d}.yaml", data, word[0])
        yield Case(f"b{number:03d}.csv", data, word[1])


# fmt: off
NO_NUMBERS = (
    *(
        ".nan",
        ".inf",
        "-.inf",
        "1e400",
        "-1e400",
        "1_000",
        "five",
        "'5'",
        "[[1]]",
        "{a: 1}",
        "true",
    ),
    *("１２", "1,5", "12:30", "5 s", "5s", "!!float 5", "&a 5", "*a", "0b11", "1e", "--1", "=1+1"),
)

NO_EXPRESSIONS = (
    *("9**9**9", "9**9**9*0", "10**400", "1e400", "1_000", "0x10", "0b1", "１", "1/0", "t/0"),
    *(
        "log(-1)",
        "sqrt(-1)",
        "0**-1",
        "(-1)**0.5",
        "exp(1000)",
        "sin",
        "sin(",
        "sin()",
        "sin(t, t)",
    ),
    *("", " ", "t t", "t +", "* t", "t ** ", "t // 1", "t % 1", "t < 1", "t == t", "not t", "~t"),
    *(
        "t & 1",
        "t if t else 1",
        "lambda: 1",
        "[t]",
        "(t,)",
        "{t}",
        "'a'",
        "t; t",
        "x",
        "T",
        "t.real",
    ),
    *(
        "().__class__",
        "t.__class__",
        "__import__('os')",
        "open('/etc/passwd')",
        "exec('1')",
        "pi()",
    ),
    *(
        "f'{t}'",
        "t := 1",
        "yield t",
        "await t",
        "t[0]",
        "t @ t",
        "...",
        "None",
        "True",
        "nan",
        "inf",
    ),
    *("sin(" * 200 + "t" + ")" * 200, "-" * 300 + "t", "+".join(["t"] * 3000), "e^t", "t^2", "2t"),
    *(
        "print(t)",
        "sin(t)(t)",
        "sin(*t)",
        "sin(x=t)",
        "t\\nt",
        "#t",
        "t # t",
        "1.2.3",
        "1e",
        ".",
        "$t",
    ),
)
# fmt: on


def _yaml() -> Iterator[tuple[str, str]]:
    places = (
        ("stop_s: 1", "time.stop_s"),
        ("step_s: 0.05", "time.step_s"),
        ("arm_deg: 0", "initial.arm_deg"),
        ("r2: 1", "reduction.r2"),
    )
    words = {"!": "the tag", "&": "the anchor &a", "*": "the alias *a"}
    for old, path in places:
        for value in NO_NUMBERS:
            text = f'"{value}"' if "'" in value else value
            section, key = path.split(".")
            if value == "1,5":  # the comma of a flow mapping: 5 is the next key
                if key != "r2":
                    yield YAML.replace(old, f"{key}: {text}"), f"{section}.5: is not a key"
                continue
            yield YAML.replace(old, f"{key}: {text}"), words.get(value[0], path)
    for expression in NO_EXPRESSIONS:
        escaped = expression.replace("\\n", "\n").replace("'", "''")
        yield YAML.replace('"30 - 2.5*t"', f"'{escaped}'"), "cab_deg"
    yield YAML.replace("name: small", "name: small\nname: other"), "name"
    yield YAML.replace("machine: des", "machine: dse"), "machine"
    yield YAML.replace("format: des-coriolis/1", "format: des-coriolis/9"), "format"
    yield YAML.replace("fork_deg", "fork"), "fork"
    yield YAML.replace("fork_deg", "fork_parsec"), "fork_parsec"
    yield YAML + "extra: 1\n", "extra"
    yield YAML + "--- \n" + YAML, "a second document"
    yield "&a " + YAML, "the anchor &a"
    yield YAML.replace("initial: {arm_deg: 0}", "initial: {<<: {arm_deg: 0}}"), "<<"
    yield YAML.replace("stop_s: 1", "stop_s: -1"), "stop_s"
    yield YAML.replace("stop_s: 1", "stop_s: 1e300"), "stop_s"
    yield YAML.replace("step_s: 0.05", "step_s: 5e-324"), "step_s"
    yield YAML.replace("step_s: 0.05", "step_s: 1e-12"), "step_s"
    for name in (
        "../../x",
        "/etc/x",
        "..",
        ".",
        "",
        " ",
        "a/b",
        "a\\\\b",
        "con",
        "nul.txt",
        "=1+1",
        "@x",
    ):
        yield YAML.replace("name: small", f'name: "{name}"'), "name"
    for name in (
        "a\\nb",
        "a\\e[2Jb",
        "a\\0b",
        "\\u202eb",
        "a" * 300,
        "😀",
        "-x",
        "+x",
        "\\tx",
        "com1",
    ):
        yield YAML.replace("name: small", f'name: "{name}"'), "name"


NO_CELLS = (
    *("nan", "NaN", "inf", "-inf", "Infinity", "1e400", "-1e400", "1_000", "１２", "١٢", "0x10"),
    *("--1", "1.2.3", "1e", "+", "-", ".", "e5", "true", "=1+1", "REF!#", "1 2", "0b1", "1d5", "∞"),
    *("1\x00", "\x00", "1,2", "", "1;2", '"', "null", "None", "1e5e5", "1.0f", "(1)", "$1", "1%"),
)


def _csv() -> Iterator[tuple[str, str]]:
    words = {"1\x00": "holds a NUL byte", "\x00": "holds a NUL byte"}
    words |= {"1,2": "has 5 cells", '"': "is not a CSV row"}
    for cell in NO_CELLS:
        for column in (0, 2):
            rows = [row.split(",") for row in ROWS]
            rows[4][column] = cell
            word = words.get(cell, HEADER.split(",")[column])
            yield csv_of([",".join(row) for row in rows]), f".csv:6: {word}"
    yield csv_of(ROWS, "t_s,arm_rpm,fork_deg,fork_deg"), "fork_deg"
    yield csv_of(ROWS, "t_s,arm_rpm,fork_deg,fork_rad"), "fork"
    yield csv_of(ROWS, "t,arm,fork,cab"), "needs its unit"
    yield csv_of(ROWS, "t_s,arm_rpm,fork_furlong,cab_deg"), "the unit furlong"
    yield csv_of(ROWS, "arm_rpm,fork_deg,cab_deg,x"), "a column is missing: t_s"
    yield csv_of([], HEADER), "no rows"
    yield csv_of(ROWS[:1], HEADER), "one row"
    yield csv_of([*ROWS[:4], *ROWS[3:]]), "t_s"
    yield csv_of([*ROWS[:4], ROWS[2], *ROWS[4:]]), "t_s"
    yield csv_of([*ROWS[:4], ROWS[4] + ",1", *ROWS[5:]]), "6: has 5 cells"
    yield csv_of([*ROWS[:4], ROWS[4].rsplit(",", 1)[0], *ROWS[5:]]), "6: has 3 cells"
    yield csv_of([row.replace(".", ",").replace(",", ";", 0) for row in ROWS]), "a decimal comma"
    # Cut inside the last number, which would still be one.
    yield csv_of(ROWS)[:-2], "cut inside"
    yield csv_of(ROWS)[:-3], "cut inside"
    yield ",".join(["x"] * 20_000) + "\n" + ",".join(["1"] * 20_000) + "\n", "has neither"
    yield "\n" * 1000, "is empty"
    yield "#" * 5000, "is empty"
    yield '"' + csv_of(ROWS), "is not a CSV header"


NEITHER = "has neither joint commands"
BLANKS = "are separated by blanks"


def _bytes() -> Iterator[tuple[bytes, tuple[str, str]]]:
    """Yield bytes, and a word of the refusal as YAML and as CSV."""
    yield b"", ("is empty", "is empty")
    yield b"\x00" * 100, ("a NUL byte", "a NUL byte")
    yield b"\xff\xfe" + YAML.encode("utf-16-le"), ("UTF-16", "UTF-16")
    yield b"\xff" + YAML.encode(), ("not UTF-8 text (byte 0xff)", BLANKS)
    yield YAML.encode().replace(b"small", b"sm\xe4ll"), ("2: is not UTF-8 text (byte 0xe4)", BLANKS)
    yield b"[" * 10_000, ("nested", NEITHER)
    yield b"{" * 10_000, ("a key must be a name", NEITHER)
    yield b"- " * 10_000, ("nested", BLANKS)
    yield b"a: " * 3000, ("is not valid YAML", BLANKS)
    yield b"PK\x03\x04" + bytes(range(256)), ("a NUL byte", "a NUL byte")
    yield b"%PDF-1.7\n" + bytes(range(128, 256)), ("2: is not UTF-8 text (byte 0x80)", NEITHER)
    yield b"PAR1" + bytes(64), ("a NUL byte", "a NUL byte")
    yield b"\x89PNG\r\n\x1a\n", ("not UTF-8 text (byte 0x89)", NEITHER)
    yield b"<!DOCTYPE html><html></html>", ("is not a profile", BLANKS)
    yield b'{"name": "x"}', ("format: is missing", NEITHER)
    yield b"null", ("is not a profile", NEITHER)
    yield b"!!python/object/apply:os.system ['true']", ("the tag", BLANKS)
    yield b"a: &x [*x, *x]", ("the anchor &x", NEITHER)
    yield b"\x1b[2J\x07", ("is not valid YAML", NEITHER)


# fmt: off
NAMES = (
    *("", " ", ".", "..", "...", "../x", "../../x"),
    *("/", "/etc/passwd", "//x", "a/b", "a\\b", "\\\\x\\y"),
    *("C:\\x", "C:", "~", "~root", "$HOME", "${HOME}"),
    *("%TEMP%", "`id`", "$(id)", "a;b", "a|b", "a&b"),
    *("-rf", "--help", "-o", "=1+1", "+1", "@SUM(A1)"),
    *("=cmd|' /C calc'!A0", "\tx", "\rx", "x\n", "a\nb"),
    *("a\x00b", "\x1b[2J", "\x1b]0;x\x07", "a\x7fb", "\u202ea"),
    *("\u200b", "\ufeff", "\ud7ff", "e\u0301"),
    *("con", "CON", "con.txt", "nul", "aux.csv", "com1"),
    *("lpt9", "COM¹", "prn .x", "a.", "a ", " a"),
    *("a" * 101, "a" * 300, "é" * 99, "😀", "日本語"),
    *("مرحبا", "ﬁ", "１", "manifest.json", "commands.csv"),
    *(".git", ".x.partial-0123abcd", "*", "?", "a:b", "a\"b"),
    *("a'b", "<b>", "{{x}}", "null", "true", "1e3"),
)
# fmt: on
"""What profiles may be called by others, in the manner of the big list of naughty strings."""
