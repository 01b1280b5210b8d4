"""The job script with which SLURM runs a scene: one MPI job over the nodes of one allocation.

srun starts all ranks, the coupler as rank 0; no mpiexec lies between. The parts of SLURM's own
heterogeneous jobs and steps never share a node, so that a coupler, which hardly computes, would
take one. Here one step has all programs: each task looks up by its number what it is, and a list of
hosts says where. SLURM sends SIGTERM to all ranks in time before the limit; the coupler alone
answers it, by a snapshot and status 130, and the script then submits itself again.
"""

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from quintet.coupler.launch.placement import Program

MARK = "# Written by quintet launch"  # in the second line of every job script
COUPLER = "coupler"
LEAVING = 60  # s for all ranks to end once the first has ended
SHARE_OF_GRACE = 0.75  # of the time before the limit; the rest is for results and the next job


@dataclass(frozen=True, slots=True)
class Job:
    """What a job script says of SLURM.

    Parameters
    ----------
    script : Path
        Its own place, absolute.
    time : str
        Limit of a job, as sbatch takes it.
    margin : int, s
        How long before the limit the run is asked to end.
    options : sequence of str
        Further options of sbatch.
    mpi : str
        How ranks join each other: an ``--mpi`` of srun.
    python : sequence of str
        Command of the interpreter, with all that must stand before it.
    """

    script: Path
    time: str
    margin: int
    options: Sequence[str]
    mpi: str
    python: Sequence[str]


@dataclass(frozen=True, slots=True)
class Rank:
    """What a component's rank runs, and for whom.

    Parameters
    ----------
    program : Program
    arguments : sequence of str
        Of ``quintet.interfaces.serving.process``, but for those that all components have.
    """

    program: Program
    arguments: Sequence[str]


def job_script(
    job: Job,
    out: Path,
    arguments: Sequence[str],
    components: Sequence[Rank],
    nodes_of: Mapping[str, Sequence[int]],
) -> str:
    """Write the script that begins a run, and that goes on with it in further jobs.

    Parameters
    ----------
    job : Job
    out : Path
        Folder of the run, absolute.
    arguments : sequence of str
        Of ``quintet run``: the scene and what changes it.
    components : sequence of Rank
    nodes_of : mapping
        Of the coupler and each component: the node of each rank, see `place`.
    """
    programs = [Program(COUPLER), *(component.program for component in components)]
    nodes = [node for program in programs for node in nodes_of[program.name]]
    head = [
        f"#!/bin/bash\n{MARK}: {arguments[0]}, into {out}",
        f"# sbatch {job.script.name}            begins",
        f"# sbatch {job.script.name} --resume   goes on from the last snapshot",
        *(f"#SBATCH {option}" for option in _directives(job, programs, nodes_of)),
    ]
    values = {
        "script": str(job.script),
        "out": str(out),
        "python": job.python,
        "begin": [*arguments, "--out", str(out)],
        "nodes": list(map(str, nodes)),
    }
    texts = [f"{name}={_bash(value)}" for name, value in values.items()]
    grace = max(1, int(SHARE_OF_GRACE * job.margin))
    run = f'run "$@" --transport mpi --inside-mpi --grace {grace}'
    cases = [f'    0) threads 1; exec "${{python[@]}}" -m quintet.coupler.cli {run} ;;']
    cases += _cases(components)
    return "\n".join(
        [*head, "", *texts, PROGRAMS.replace("CASES", "\n".join(cases)), _step(job), AFTER]
    )


def _directives(
    job: Job, programs: Sequence[Program], nodes_of: Mapping[str, Sequence[int]]
) -> list[str]:
    used: dict[int, int] = {}
    for program in programs:
        for node in nodes_of[program.name]:
            used[node] = used.get(node, 0) + program.threads
    return [
        f"--nodes={len(used)} --ntasks={len(used)} --ntasks-per-node=1",
        f"--cpus-per-task={max(used.values())}",
        f"--time={job.time} --signal=TERM@{job.margin}",
        *map(shlex.quote, job.options),  # sbatch reads quotes as a shell does
    ]


def _cases(components: Sequence[Rank]) -> list[str]:
    """What each task is; those of one component follow each other."""
    cases, first = [], 1
    for component in components:
        program = component.program
        numbers = "|".join(map(str, range(first, first + program.ranks)))
        words = shlex.join([program.name, str(program.threads), *component.arguments])
        cases.append(f"    {numbers}) component {words} ;;")
        first += program.ranks
    return cases


def _step(job: Job) -> str:
    options = f"--kill-on-bad-exit=0 --wait={LEAVING} --overcommit --cpu-bind=none"
    return f"""{_netmod(job)}SLURM_HOSTFILE=$places srun --mpi={job.mpi} {options} \\
    --distribution=arbitrary --ntasks=${{#nodes[@]}} bash "$script" --rank "${{what[@]}}"
status=$?
# The step's status may be that of a component which srun has killed as the coupler ended.
said=$(grep -o '"status": [0-9]*' "$out/log/mpi.json" 2> /dev/null | grep -o '[0-9]*$')
if [ -z "$said" ] && [ $status -le 1 ]; then status=3; fi # the coupler did not end in order
status=${{said:-$status}}
rm -f "$places" "$out"/log/*.exit*"""


def _netmod(job: Job) -> str:
    """Choose a network layer of MPICH whose addresses SLURM's pmi2 can pass on.

    It reads lines of 1 KiB. MPICH sends addresses of UCX, which have several, in parts that are
    longer than that where they are not mostly zeros: then a start fails, now and then. Those of
    libfabric have 16 bytes.
    """
    return "export MPIR_CVAR_CH4_NETMOD=${MPIR_CVAR_CH4_NETMOD-ofi}\n" if job.mpi == "pmi2" else ""


def _bash(value: str | Sequence[str]) -> str:
    return shlex.quote(value) if isinstance(value, str) else f"({shlex.join(value)})"


PROGRAMS = """
threads() {
    export NUMBA_NUM_THREADS=$1 OMP_NUM_THREADS=$1 OPENBLAS_NUM_THREADS=$1 OMP_WAIT_POLICY=passive
}

# A component leaves SIGTERM to the coupler. How it ended stands in a file, as the coupler may be on
# another node; the step's status is the coupler's alone.
component() {
    trap '' TERM
    threads "$2"
    end=$out/log/$1.exit
    case " $* " in *" --ranks "*) end=$end.$SLURM_PROCID ;; esac
    "${python[@]}" -m mpi4py -m quintet.interfaces.serving.process "${@:3}" \\
        --name "$1" --mpi --log "$out/log/$1.log"
    echo $? > "$end"
    exit 0
}

if [ "${1-}" = --rank ]; then
    shift
    case $SLURM_PROCID in
CASES
    esac
fi

last_snapshot() { ls -v "$out"/snapshot-*.h5 2> /dev/null | tail -n 1; }

before=$(last_snapshot)
what=("${begin[@]}")
if [ "${1-}" = --resume ]; then what=(--resume "$out"); fi
rm -f "$out"/log/*.exit* "$out/log/mpi.json" # of the job before: how it ended
hosts=($(scontrol show hostnames "$SLURM_JOB_NODELIST"))
places=$(mktemp)
for node in "${nodes[@]}"; do echo "${hosts[node]}"; done > "$places"
# Of the allocation, not of the step.
unset SLURM_NTASKS SLURM_NPROCS SLURM_NTASKS_PER_NODE SLURM_TASKS_PER_NODE SLURM_CPUS_PER_TASK"""

AFTER = """
after=$(last_snapshot)
state=$(squeue --noheader --jobs="$SLURM_JOB_ID" --format=%T)
if [ $status -eq 0 ] || [ $status -eq 1 ]; then
    echo "quintet launch: the run is done, with status $status"
elif [ $status -ne 130 ]; then
    echo "quintet launch: the run failed with status $status; it is not submitted again"
    echo "to go on from its last snapshot, if it has one: sbatch $script --resume"
elif [ "$state" != RUNNING ]; then
    echo "quintet launch: the job is $state, so it was cancelled; it is not submitted again"
    echo "to go on: sbatch $script --resume"
elif [ "$after" = "$before" ]; then
    echo "quintet launch: no snapshot was written in this job, so that the next one would do the" \\
        "same again; it is not submitted again. Give it more --time, or a longer --margin."
elif sbatch --dependency=afterany:"$SLURM_JOB_ID" "$script" --resume; then
    echo "quintet launch: ended in ${after##*/}; submitted again, to go on from there"
else
    echo "quintet launch: SLURM refused the next job; to go on: sbatch $script --resume"
fi
exit $status
"""
