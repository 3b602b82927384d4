"""Jobs say where their output goes, and results how they ended."""

import pickle
from pathlib import Path

from des_cli.batch.job import Job, JobResult, Output, split_jobs
from des_cli.batch.source import Source
from des_cli.errors import Complaint, ExitCode, ProfileError

LOG = "t_s,p_rad_s,q_rad_s,r_rad_s\n0,0,0,1\n0.1,0,0,1\n4,0,0,1\n4.1,0,0,1\n"


def test_a_folder_of_runs_names_them_and_any_other_output_is_as_given() -> None:
    assert Output().destination("cobra") == Path("runs/cobra")
    assert Output("all").destination("cobra") == Path("all/cobra")
    assert Output("x.csv", out_is_parent=False).destination("cobra") == Path("x.csv")


def test_stretches_of_a_record_share_a_folder_and_a_whole_profile_keeps_its_own() -> None:
    output = Output("here", out_is_parent=False)
    split = Source("-", ("gap=split",), stdin=LOG.encode())
    cobra = Job(Source("cobra"), output)
    *stretches, whole = split_jobs([Job(split, output), cobra])
    assert [job.source.part for job in stretches] == [1, 2]
    assert [job.output for job in stretches] == [Output("here", out_is_parent=True)] * 2
    assert whole == cobra
    assert whole.label == "cobra"


def test_an_exception_becomes_a_result_with_its_code_and_all_its_lines() -> None:
    job = Job(Source("cobra"))
    error = ProfileError([Complaint("time", "is wrong"), Complaint("seat", "is missing")])
    failed = JobResult.failed(job, error, "cobra-1")
    assert (failed.source, failed.name, failed.state) == ("cobra", "cobra-1", "failed")
    assert (failed.exit_code, failed.ok) == (ExitCode.PROFILE, False)
    assert failed.complaints == ("time: is wrong", "seat: is missing")
    assert failed.traceback == ""
    assert JobResult("cobra", "cobra").ok
    assert pickle.loads(pickle.dumps(failed)) == failed
