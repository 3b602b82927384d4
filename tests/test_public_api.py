"""The Python interface: the names of ``des_cli``, imported on first use."""

import importlib.metadata

import pytest

import des_cli


def test_public_names_can_be_imported() -> None:
    for name in des_cli.__all__:
        assert getattr(des_cli, name) is not None
    assert set(des_cli.__all__) <= set(dir(des_cli))


def test_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'reduce_profil'"):
        _ = des_cli.reduce_profil


def test_version_is_that_of_the_installed_distribution() -> None:
    try:
        installed = importlib.metadata.version("des-coriolis")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("not installed")
    assert des_cli.__version__ == installed
