"""``schema``: a JSON Schema on stdout."""

import json


def test_schema_names_every_section(invoke) -> None:
    result = invoke("schema")
    assert (result.exit_code, result.stderr) == (0, "")
    schema = json.loads(result.stdout)
    assert {"format", "name", "machine", "seat", "time", "joints", "body_rates", "samples"} <= set(
        schema["properties"]
    )
    assert result.stdout.endswith("}\n")
