#!/bin/bash
#SBATCH --job-name=friction
#SBATCH --array=0-2
#SBATCH --ntasks=8
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
# A run for each value of a parameter, in a folder of its own; each requeues itself until it has ended.
# Change the lines above, the job file, the parameter with its values (one for each number of the array),
# and the folder.
job=${JOB:-jobs/hopper.yaml}
key=contact.pairs.0.friction
values=(0.3 0.4 0.5)
value=${values[$SLURM_ARRAY_TASK_ID]}
run=${RUNS:-runs}/friction_$value

AGAIN=yes MACHINE=slurm exec config/launch bin/tremie run "$job" --out "$run" --set "$key=$value"
