# Luo & Zhao, example 1: the equations as they must read.
# Names are those of luo-zhao-example-1.toml; lambda is the multiplier of the only constraint.
# Checked against the equations that the program derives.

# The square of the relative speed; (4.1) and (4.2) contain the same sum, once in the constraint and once in T_r.
4.1: r'^2 + r^2*psi'^2 + r^2*cos(psi)^2*phi'^2 = c^2
# Routh's equations for r, psi (latitude), phi (longitude). How the terms of (4.3) are arranged in print is not known here:
# every line means the equation as a whole.
4.3.r: m*(r'' - r*psi'^2 - r*cos(psi)^2*phi'^2) = -k2*m/r^2 + m'*ur + m*w^2*r*cos(psi)^2 + 2*m*w*r*cos(psi)^2*phi' + 2*lambda*r'
4.3.psi: m*(r^2*psi'' + 2*r*r'*psi' + r^2*sin(psi)*cos(psi)*phi'^2) = m'*r*up - m*w^2*r^2*sin(psi)*cos(psi) - 2*m*w*r^2*phi'*sin(psi)*cos(psi) + 2*r^2*psi'*lambda
4.3.phi: m*(r^2*cos(psi)^2*phi'' + 2*r*r'*cos(psi)^2*phi' - 2*r^2*sin(psi)*cos(psi)*psi'*phi') = m'*r*cos(psi)*uf - 2*m*w*r*r'*cos(psi)^2 + 2*m*w*r^2*sin(psi)*cos(psi)*psi' + 2*r^2*cos(psi)^2*phi'*lambda
# (4.4) is not given here: what it says is not known from the notes these files were written from.
