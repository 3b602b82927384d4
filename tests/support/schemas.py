"""Values as YAML gives them, checked against a part of the schema."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.yaml_nodes import parse_yaml


def accepted(schema: Any, text: str) -> Any:
    """What a part of the schema makes of a text."""
    return TypeAdapter(schema).validate_python(parse_yaml(text, "f.yaml").plain())


def refused(schema: Any, text: str) -> list[str]:
    """Everything that a part of the schema says against a text."""
    findings = Findings(parse_yaml(text, "f.yaml"))
    with pytest.raises(ValidationError) as caught:
        TypeAdapter(schema).validate_python(findings.root.plain())
    findings.add_validation(caught.value)
    return [str(complaint) for complaint in findings.complaints]
