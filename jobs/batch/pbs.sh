#!/bin/bash
#PBS -N hopper
#PBS -l select=1:ncpus=8:mpiprocs=8
#PBS -l walltime=12:00:00
#PBS -j oe
#PBS -r y
# Submits itself again until the run has ended; PBS runs it again when a node fails.
# (TORQUE: -l nodes=1:ppn=8.)
# Change the lines above, the wall time also here, the job file and the run's folder.
wall=12:00:00
script=jobs/batch/pbs.sh
job=jobs/hopper.yaml
run=runs/hopper

cd "$PBS_O_WORKDIR" || exit 2
AGAIN=$script MACHINE=pbs exec config/launch bin/tremie run "$job" --out "$run" --wall "$wall"
