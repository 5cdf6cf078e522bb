#!/bin/bash
#SBATCH --job-name=hopper
#SBATCH --ntasks=8
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
# Requeues itself until the run has ended; Slurm requeues it when a node fails or another job preempts it.
# Change the lines above, the job file and the run's folder.
job=${JOB:-jobs/hopper.yaml}
run=${RUN:-runs/hopper}

AGAIN=yes MACHINE=slurm exec config/launch bin/tremie run "$job" --out "$run"
